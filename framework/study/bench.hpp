#pragma once

#include <memory>
#include <vector>

#include "butee/dynamics/modal_dashpots.hpp"
#include "butee/scene/assembly.hpp"
#include "butee/study/study.hpp"

namespace butee::study {

/// The system that a thread works on. It is kept from one run of a study to the next if only loads,
/// stops, gaps, laws or the start change: assembly, factorizations and modes are then computed
/// once. Results are bit-identical to those of a new system.
class Bench {
 public:
  /// `study` must outlive this object.
  explicit Bench(const Study& study);

  /// Takes the scene of a run. Throws as scene::Assembly does.
  void take(std::unique_ptr<scene::Scene> scene, const std::vector<config::Value>& values);

  scene::Scene& scene() { return *scene_; }
  dynamics::Dynamics& dynamics() { return parts_->dynamics; }
  time::Simulation& simulation() { return *simulation_; }
  /// For this run alone: number of assemblies, 0 or 1, and the counts of the dynamics.
  int assemblies() const { return assemblies_; }
  linalg::Counters counters() const;

 private:
  struct Parts {
    explicit Parts(const scene::Scene& scene) : system(dynamics::assemble_to_run(scene.model)), dynamics(system) {}
    model::System system;
    dynamics::Dynamics dynamics;
  };

  bool renew(const std::string& structure);

  const Study& study_;
  std::vector<bool> is_structural_;  ///< one entry per axis: its key belongs to a table other than those of loads and
                                     ///< stops
  std::unique_ptr<scene::Scene> base_, scene_;  ///< base_: owner of the nodes that the system refers to, if that is not
                                                ///< scene_
  std::unique_ptr<Parts> parts_;
  std::unique_ptr<time::Integrator> integrator_;
  std::unique_ptr<time::Simulation> simulation_;
  std::string structure_;
  int assemblies_ = 0;
  linalg::Counters before_;
};

}  // namespace butee::study
