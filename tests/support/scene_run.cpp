#include "support/scene_run.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>

#include <butee/config/override.hpp>
#include <butee/config/toml.hpp>
#include <butee/core/error.hpp>
#include <gtest/gtest.h>

namespace butee::test {
namespace {

const plugin::Catalogue& catalogue() {
  static const plugin::Catalogue instance = [] {
    plugin::Catalogue made;
    made.add(BUTEE_TEST_PLUGINS);
    return made;
  }();
  return instance;
}

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  if (!line.empty() && line.back() == ',') cells.emplace_back();
  return cells;
}

}  // namespace

std::string model_path(const std::string& stem) {
  return std::string(BUTEE_TEST_MODELS) + "/" + stem + ".toml";
}

std::string with_linear_law(const std::string& stem) {
  std::string text = read_file(model_path(stem));
  for (const auto& [start, by] :
       {std::pair{"\nlaw ", "\nlaw = \"linear\" #"}, std::pair{"\nregularization ", "\n# "}}) {
    const std::size_t at = text.find(start);
    EXPECT_NE(at, std::string::npos);
    text.replace(at, std::string(start).size(), by);
  }
  return text;
}

std::string read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("cannot read " + path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

scene::Scene read_scene(const std::string& toml, const std::vector<std::string>& overrides) {
  config::Document document = config::parse_toml(toml, "scene.toml");
  for (const std::string& assignment : overrides) config::apply_override(document, assignment);
  return scene::read_scene(std::move(document), catalogue());
}

SceneRun::SceneRun(const std::string& toml, const std::vector<std::string>& overrides)
    : parts_(new Parts{read_scene(toml, overrides)}) {}

SceneRun SceneRun::of_model(const std::string& stem, const std::vector<std::string>& overrides) {
  return SceneRun(read_file(model_path(stem)), overrides);
}

Index SceneRun::dof(const std::string& selector, DofKind kind) const {
  const auto selection = model().nodes.select(selector);
  if (selection.nodes.size() != 1) throw std::runtime_error(selector + ": " + selection.problem);
  return system().dofs.index({selection.nodes.front(), kind});
}

void Sampler::start(const time::State& state) {
  if (times_.empty() || times_.front() > state.t) return;
  x.push_back(state.x[dof_]);
  v.push_back(state.v[dof_]);
}

double Sampler::next_instant(double t) const {
  const auto next = std::upper_bound(times_.begin(), times_.end(), t);
  return next == times_.end() ? std::numeric_limits<double>::infinity() : *next;
}

void Sampler::step(const time::AcceptedStep& step) {
  // A time that exceeds the end of a step only by rounding belongs to that step.
  const double slack = 1e-9 * step.h;
  while (x.size() < times_.size() && times_[x.size()] <= step.to.t + slack) {
    const double t = std::min(times_[x.size()], step.to.t);
    double xi = 0.0, vi = 0.0;
    step.motion.interpolate(t, {&dof_, 1}, {{&xi, 1}, {&vi, 1}, {}});
    x.push_back(xi);
    v.push_back(vi);
  }
}

double relative_rms(const std::vector<double>& x, const std::vector<double>& reference) {
  require(x.size() == reference.size() && !x.empty(), "two series of one length");
  double difference = 0.0, size = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    difference += (x[i] - reference[i]) * (x[i] - reference[i]);
    size += reference[i] * reference[i];
  }
  return std::sqrt(difference / size);
}

CsvTable::CsvTable(const std::string& path) {
  std::istringstream lines(read_file(path));
  std::string line;
  while (std::getline(lines, line)) {
    if (line.empty() || line.front() == '#') continue;
    if (header_.empty())
      header_ = split(line);
    else
      cells_.push_back(split(line));
  }
}

std::vector<std::string> CsvTable::text_column(const std::string& name) const {
  const auto found = std::find(header_.begin(), header_.end(), name);
  if (found == header_.end()) throw std::runtime_error("no column " + name);
  const auto index = static_cast<std::size_t>(found - header_.begin());
  std::vector<std::string> values;
  for (const auto& row : cells_) values.push_back(row.at(index));
  return values;
}

std::vector<double> CsvTable::column(const std::string& name) const {
  std::vector<double> values;
  for (const std::string& cell : text_column(name)) values.push_back(std::stod(cell));
  return values;
}

}  // namespace butee::test
