#pragma once

#include <memory>

#include "butee/record/local_maximum.hpp"
#include "butee/record/probes.hpp"

namespace butee::record {

/// Follows the largest |value| of probes of contacts in the plane, with dissipation or friction, over the whole motion:
/// at kSamples instants of each piece of a step, from which local maxima are refined on the method's dense output.
class BUTEE_EXPORT ContactPeaks {
 public:
  static constexpr int kSamples = 8;

  /// Takes those quantities of `requests` that such contacts give. `dynamics` must outlive it.
  ContactPeaks(const std::vector<model::ProbeRequest>& requests, dynamics::Dynamics& dynamics);

  void start(const time::State& state);
  void step(const time::AcceptedStep& step);
  void save(ByteWriter& to) const { to.put(largest_); }
  void restore(ByteReader& from) { from.take(largest_); }

  /// By column, "mid.normal_force", into `peaks`.
  void add_to(std::map<std::string, double>& peaks) const;

 private:
  /// False where no contact can exert a force within the step.
  bool is_active() const;
  void follow_piece(const time::AcceptedStep& step, double begin, double end);

  dynamics::Dynamics& dynamics_;
  std::unique_ptr<Probes> probes_;  ///< null where there are none
  std::vector<double> largest_, values_, now_;
  std::vector<std::array<Sampled, 2>> last_;  ///< of each column, the two samples before
};

}  // namespace butee::record
