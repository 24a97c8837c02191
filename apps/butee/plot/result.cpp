#include "result.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <utility>

#include <butee/config/file_reference.hpp>
#include <butee/config/toml.hpp>
#include <butee/core/error.hpp>
#include <butee/scene/read_output.hpp>
#include <butee/scene/read_scene.hpp>

#include "contact_places.hpp"

namespace butee::app::plot {
namespace {

namespace fs = std::filesystem;
using config::Value;

constexpr const char* kEnding = "-results";

/// "runs/beam1-results/" -> "beam1"
std::string label_of(const std::string& folder) {
  fs::path path = fs::path(folder).lexically_normal();
  if (!path.has_filename()) path = path.parent_path();
  std::string name = path.filename().string();
  if (name.empty() || name == "." || name == "..") name = fs::weakly_canonical(folder).filename().string();
  if (name.size() > std::string(kEnding).size() && name.ends_with(kEnding))
    name.resize(name.size() - std::string(kEnding).size());
  return name;
}

/// Collects the frequencies of a load and of its time function, Hz.
void add_frequency(const Value& load, std::vector<double>& frequencies) {
  const config::Table* table = load.table();
  if (table == nullptr) return;
  if (const Value* in_time = table->find("in_time")) add_frequency(*in_time, frequencies);
  for (const char* key : {"angular_frequency", "speed"})
    if (const Value* given = table->find(key))
      if (const auto omega = config::as_number(*given); omega && *omega != 0.0)
        frequencies.push_back(std::abs(*omega) / (2.0 * std::numbers::pi));
}

std::vector<double> frequencies_of(const config::Document& document) {
  std::vector<double> frequencies;
  const Value* loads = document.root.table()->find("load");
  if (loads != nullptr && loads->array() != nullptr)
    for (const Value& load : *loads->array()) add_frequency(load, frequencies);
  std::sort(frequencies.begin(), frequencies.end());
  const auto alike = [](double a, double b) { return b - a <= 1e-9 * b; };
  frequencies.erase(std::unique(frequencies.begin(), frequencies.end(), alike), frequencies.end());
  return frequencies;
}

/// The format of the fields in the folder, if the scene asked for fields and their file exists.
std::string field_format_of(const config::Document& document, const std::string& folder) {
  const Value* output = document.root.table()->find("output");
  const Value* formats = output != nullptr && output->table() != nullptr ? output->table()->find("formats") : nullptr;
  if (formats == nullptr) return "";
  std::vector<Value> names = formats->array() != nullptr ? *formats->array() : std::vector<Value>{*formats};
  for (const Value& name : names)
    if (name.text() != nullptr && *name.text() != "csv")
      for (const auto& entry : fs::directory_iterator(folder))
        if (entry.path().stem() == "fields") return *name.text();
  return "";
}

}  // namespace

Result read_result(const std::string& folder, const plugin::Catalogue& catalogue, Window window) {
  const std::string model_path = (fs::path(folder) / "model.toml").string();
  const std::string history_path = (fs::path(folder) / "history.csv").string();
  if (!fs::is_directory(folder)) throw InputError(folder + ": is not a folder; name the result folder of `butee run`");
  if (!fs::exists(model_path)) throw InputError(folder + ": holds no results of `butee run`: model.toml is missing");
  if (!fs::exists(fs::path(folder) / "summary.json") && fs::exists(fs::path(folder) / "report.md"))
    throw InputError(folder + ": is a folder of `butee compare`, whose pictures are already in it");
  // Pictures do not need the time functions of loads, and the result folder may have been moved away from
  // their files.
  const config::Document document = config::without_files(config::load_toml(model_path));
  config::Diagnostics diagnostics(document);
  const scene::Draft scene = scene::read_draft(document, catalogue, diagnostics);
  diagnostics.throw_if_any();
  // Mistakes in [output], such as a format whose module is not installed, do not matter for pictures.
  config::Diagnostics of_output(document);
  const auto output = scene::read_output(document.root, scene.model, scene.integrator->options.end_time, of_output,
                                         catalogue.types().formats);
  Result result;
  result.folder = folder;
  result.label = label_of(folder);
  result.title = scene.model.title;
  result.field_format = field_format_of(document, folder);
  if (fs::exists(history_path))
    result.history = read_table(history_path, window);
  else if (result.field_format.empty())
    throw InputError(folder + ": holds no results of `butee run`: history.csv is missing");
  if (const auto energy = fs::path(folder) / "energy.csv"; fs::exists(energy))
    result.energy = read_table(energy.string(), window);
  for (const model::ProbeRequest& probe : output.probes)
    result.probes.push_back({probe.label, probe.quantities, gaps_of(scene.model, probe.node, DofKind::uy),
                             gaps_of(scene.model, probe.node, DofKind::uz), walls_of(scene.model, probe.node)});
  find_contact_places(scene.model, result);
  result.frequencies = frequencies_of(document);
  if (const auto* rotation = scene.model.rotation.get(); rotation != nullptr && !rotation->is_constant())
    for (const double t : result.history.times()) result.speeds.push_back(rotation->speed(t));
  return result;
}

const std::vector<double>* Result::column(const std::string& probe, const std::string& quantity) const {
  constexpr std::array<std::pair<const char*, const char*>, 5> kTwoNames = {
      {{"u", "uy"}, {"v", "uy_v"}, {"a", "uy_a"}, {"uz", "w"}, {"theta", "rz"}}};
  if (const auto* found = history.find(probe + "." + quantity)) return found;
  for (const auto& [name, other] : kTwoNames)
    if (quantity == name) return history.find(probe + "." + other);
  return nullptr;
}

void make_labels_unique(std::vector<Result>& results) {
  for (const Result& one : results) {
    const auto same = [&](const Result& other) { return other.label == one.label; };
    if (std::count_if(results.begin(), results.end(), same) == 1) continue;
    const std::string label = one.label;
    for (Result& other : results)
      if (other.label == label) other.label = fs::path(other.folder).lexically_normal().string();
  }
}

}  // namespace butee::app::plot
