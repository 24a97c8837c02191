#include "reference.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>

#include <butee/core/error.hpp>
#include <butee/core/text.hpp>
#include <butee/dynamics/modal_system.hpp>
#include <butee/study/table.hpp>

#include "../interruption.hpp"

namespace butee::app::compare {
namespace {

/// Two reference solutions have diverged once they differ by this fraction of the peak.
constexpr double kParted = 1e-3;
/// The scale of a column is at least this fraction of the largest peak of its quantity (chosen, as for error control).
constexpr double kOfOthers = 1e-3;
/// Longest time for a reference solution, s.
constexpr double kTimeLimit = 600.0;
constexpr double kSameRow = 1e-9;

/// Tolerance of `exponential`, used if `exact` refuses the scene.
constexpr double kTight = 1e-8;

/// Perturbation of the initial displacements in the second computation, relative to the peak.
constexpr double kRounding = 1e-16;

double largest_of(const std::vector<double>& values) {
  double largest = 0.0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  return largest;
}

Values compute(const config::Document& scene, const plugin::Catalogue& catalogue, const Question& question,
               const std::string& method, config::Table settings, double perturbation) {
  plugin::Catalogue own = catalogue;
  const time::IntegratorType& type = own.load(method);
  const Sweep sweep{method, "", true, {}, std::move(settings)};
  config::Document document = with_method(scene, type, sweep, 0.0);
  scene::Scene session = scene::read_scene(std::move(document), own);
  Answer answer = run_once(session, question, kTimeLimit, perturbation);
  if (interruption() != nullptr) throw RunError("interrupted during the reference; earlier comparisons are kept");
  if (!answer.completed)
    throw RunError("the reference by " + method + " failed: " + answer.message +
                   "; give one as a file ([study] reference) or another horizon (end_time)");
  return std::move(answer.values);
}

/// The quantity of a column "LABEL.QUANTITY".
std::string kind_of_column(const std::string& column) {
  return column.substr(column.rfind('.') + 1);
}

/// The number of leading instants at which both solutions agree in every column, relative to its peak or, if that is
/// much larger, to the peaks of others of the same quantity: what is at rest differs by their rounding.
std::size_t agreement(const Values& a, const Values& b, const std::vector<std::string>& columns) {
  std::map<std::string, double> peaks;
  for (std::size_t column = 0; column < a.size(); ++column) {
    double& peak = peaks[kind_of_column(columns[column])];
    peak = std::max(peak, largest_of(a[column]));
  }
  std::size_t agreed = a.front().size();
  for (std::size_t column = 0; column < a.size(); ++column) {
    const double scale = std::max(largest_of(a[column]), kOfOthers * peaks[kind_of_column(columns[column])]);
    for (std::size_t i = 0; i < agreed; ++i)
      if (std::abs(a[column][i] - b[column][i]) > kParted * scale) agreed = i;
  }
  return agreed;
}

void compare_both(const Values& other, const Question& question, Reference& reference) {
  const std::size_t agreed = agreement(reference.values, other, question.columns);
  reference.parted = agreed < question.times.size();
  reference.horizon = agreed > 0 ? question.times[agreed - 1] : 0.0;
  for (auto& column : reference.values) column.resize(agreed);
  const Error difference = error_of(other, reference);
  reference.uncertainty = std::isfinite(difference.rms) ? difference.rms : 0.0;
}

/// A column of the file, sampled at the times of the question.
std::vector<double> read_column(const std::string& path, const std::string& column, const Question& question) {
  std::ifstream file(path);
  if (!file) throw InputError("study.reference = \"" + path + "\": cannot be read");
  std::string line;
  std::size_t number = 1;
  while (std::getline(file, line) && line.starts_with('#')) ++number;
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (line.starts_with(kByteOrderMark)) line.erase(0, kByteOrderMark.size());
  const std::vector<std::string> header = study::cells_of(line);
  const auto place = [&](const std::string& name) {
    const auto found = std::find(header.begin(), header.end(), name);
    if (found == header.end()) throw InputError(path + ": there is no column \"" + name + "\"; it has " + join(header));
    return static_cast<std::size_t>(found - header.begin());
  };
  const std::size_t t = place("t"), value = place(column);
  std::vector<double> values;
  while (values.size() < question.times.size() && std::getline(file, line)) {
    ++number;
    const auto cells = study::cells_of(line);
    const auto number_in = [&](std::size_t i) {
      const auto read = i < cells.size() ? number_of(cells[i]) : std::nullopt;
      if (!read) throw InputError(path + ":" + std::to_string(number) + ": is not a row of numbers");
      return *read;
    };
    const double at = question.times[values.size()];
    if (std::abs(number_in(t) - at) <= kSameRow * question.times.back()) values.push_back(number_in(value));
  }
  if (values.size() < question.times.size())
    throw InputError(path + ": has no row at t = " + to_short_text(question.times[values.size()]) +
                     " s; it must hold every output time of the scene");
  return values;
}

}  // namespace

Reference find_reference(const Study& study, const config::Document& scene, plugin::Catalogue& catalogue,
                         const Question& question) {
  Reference reference;
  if (!study.reference_file.empty()) {
    reference.origin = study.reference_file + ", used as given";
    for (const std::string& column : question.columns)
      reference.values.push_back(read_column(study.reference_file, column, question));
    reference.horizon = question.times.back();
    return reference;
  }
  if (catalogue.find("exact") == nullptr)
    throw InputError("the method exact, which computes references, is not installed; give a file: [study] reference");
  const auto by = [&](const std::string& method, const std::string& key, config::Value value, double perturbation) {
    config::Table settings;
    settings[key] = std::move(value);
    return compute(scene, catalogue, question, method, std::move(settings), perturbation);
  };
  const auto perturbation = [&] {
    double peak = 0.0;
    for (const auto& column : reference.values) peak = std::max(peak, largest_of(column));
    return kRounding * peak;
  };
  try {
    reference.values = by("exact", "order", config::Value(std::int64_t{30}), 0.0);
    reference.method = "exact";
    reference.origin = "exact at order 30, and at order 22 from a start that differs by rounding";
    compare_both(by("exact", "order", config::Value(std::int64_t{22}), perturbation()), question, reference);
  } catch (const InputError&) {
    // Without all modes, `exponential` would agree only with itself.
    const auto dofs = assemble(scene::read_scene(scene, catalogue).model).size();
    if (!reference.values.empty() || catalogue.find("exponential") == nullptr ||
        dofs > dynamics::ModalSystem::kAllModes)
      throw;
    reference.values = by("exponential", "tolerance", config::Value(kTight), 0.0);
    reference.method = "exponential";
    reference.origin = "exponential with a tolerance of " + to_short_text(kTight) + ", and of " +
                       to_short_text(10.0 * kTight) +
                       " from a start that differs by rounding, since exact refuses the scene";
    compare_both(by("exponential", "tolerance", config::Value(10.0 * kTight), perturbation()), question, reference);
  }
  return reference;
}

Error error_of(const Values& values, const Reference& reference) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  Error worst;
  for (std::size_t column = 0; column < reference.values.size(); ++column) {
    const std::vector<double>& expected = reference.values[column];
    if (values[column].size() < expected.size()) return {kInfinite, kInfinite};
    double squares = 0.0, all = 0.0, largest = 0.0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const double difference = values[column][i] - expected[i];
      squares += difference * difference;
      all += expected[i] * expected[i];
      largest = std::max(largest, std::abs(difference));
    }
    if (all == 0.0 && squares == 0.0) continue;
    if (!(all > 0.0)) return {kInfinite, kInfinite};
    worst.rms = std::max(worst.rms, std::sqrt(squares / all));
    worst.largest = std::max(worst.largest, largest / largest_of(expected));
  }
  return worst;
}

}  // namespace butee::app::compare
