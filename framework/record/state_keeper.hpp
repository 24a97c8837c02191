#pragma once

#include "butee/model/saved_motion.hpp"
#include "butee/time/simulation.hpp"

namespace butee::record {

/// Saves the motion of all DOFs at given instants, by the method's own interpolant, for runs that
/// start from there.
class BUTEE_EXPORT StateKeeper final : public time::Observer {
 public:
  /// `times` (s) ascend. `dynamics` must outlive this object and be that of an assembled model.
  StateKeeper(std::vector<double> times, dynamics::Dynamics& dynamics);

  void start(const time::State& state) override;
  void step(const time::AcceptedStep& step) override;
  double next_instant(double t) const override;
  void save(ByteWriter& to) const override;
  void restore(ByteReader& from) override;

  /// Writes the motions saved so far and `last`, with the structure. Throws RunError.
  /// The file is not synchronised with the device, which would take longer than a short run: an
  /// incomplete file is detected by its checksum.
  void write(const std::string& path, const time::State& last) const;

 private:
  model::SavedMotion motion_at(const time::State& state) const;

  dynamics::Dynamics& dynamics_;
  std::vector<double> times_;
  std::vector<Index> all_;
  std::vector<model::SavedMotion> kept_;
};

}  // namespace butee::record
