#pragma once

#include <memory>
#include <string>
#include <vector>

#include <butee/record/energy.hpp>
#include <butee/record/impacts.hpp>
#include <butee/scene/assembly.hpp>

namespace butee::test {

/// Path of a scene of apps/models given its stem: "beam1".
std::string model_path(const std::string& stem);
std::string read_file(const std::string& path);
/// A model of the paper with the linear law instead of its own.
std::string with_linear_law(const std::string& stem);

/// Reads a scene from TOML text with overrides ("integrator.type=NM1"), with modules from the build tree.
/// Throws InputError if the program would refuse the scene.
scene::Scene read_scene(const std::string& toml, const std::vector<std::string>& overrides = {});

/// A scene read by read_scene() and assembled, ready to run in a test.
class SceneRun {
 public:
  explicit SceneRun(const std::string& toml, const std::vector<std::string>& overrides = {});
  static SceneRun of_model(const std::string& stem, const std::vector<std::string>& overrides = {});

  dynamics::Dynamics& dynamics() { return parts_->assembly.dynamics; }
  const model::System& system() const { return parts_->assembly.system; }
  const model::Model& model() const { return parts_->scene.model; }
  time::Integrator& integrator() { return *parts_->assembly.integrator; }
  time::Simulation& simulation() { return parts_->assembly.simulation; }
  /// The free DOF of the node named by a selector.
  Index dof(const std::string& selector, DofKind kind = DofKind::u) const;

  /// Runs to the end.
  const time::RunReport& run() { return parts_->assembly.simulation.run(); }

 private:
  struct Parts {
    scene::Scene scene;
    scene::Assembly assembly{scene};
  };
  std::unique_ptr<Parts> parts_;
};

/// Samples x and v of one DOF at given ascending times, by the method's own interpolant.
class Sampler final : public time::Observer {
 public:
  Sampler(Index dof, std::vector<double> times) : dof_(dof), times_(std::move(times)) {}
  void start(const time::State& state) override;
  void step(const time::AcceptedStep& step) override;
  double next_instant(double t) const override;

  std::vector<double> x, v;

 private:
  Index dof_;
  std::vector<double> times_;
};

/// The largest |x| of one DOF over t = 0 and all accepted steps.
class Peak final : public time::Observer {
 public:
  explicit Peak(Index dof) : dof_(dof) {}
  void start(const time::State& state) override { value = std::abs(state.x[dof_]); }
  void step(const time::AcceptedStep& step) override { value = std::max(value, std::abs(step.to.x[dof_])); }

  double value = 0.0;

 private:
  Index dof_;
};

/// sqrt(sum (x - ref)^2 / sum ref^2)
double relative_rms(const std::vector<double>& x, const std::vector<double>& reference);

/// The columns of a CSV file of numbers with one header line, by name.
class CsvTable {
 public:
  explicit CsvTable(const std::string& path);
  std::vector<double> column(const std::string& name) const;
  std::vector<std::string> text_column(const std::string& name) const;
  std::size_t rows() const { return cells_.size(); }
  const std::vector<std::string>& header() const { return header_; }

 private:
  std::vector<std::string> header_;
  std::vector<std::vector<std::string>> cells_;
};

}  // namespace butee::test
