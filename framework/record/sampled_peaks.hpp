#pragma once

#include <memory>

#include "butee/record/local_maximum.hpp"
#include "butee/record/probes.hpp"

namespace butee::record {

/// Records the largest |value| of probes that Peaks does not follow, over the whole motion: at kSamples instants of
/// each piece of a step between breakpoints, or kSamplesOfQuintic of pieces that are near a quintic, from which local
/// maxima are refined on the method's dense output.
class BUTEE_EXPORT SampledPeaks {
 public:
  static constexpr int kSamples = 8, kSamplesOfQuintic = 3;

  /// Contacts in the plane, with dissipation or friction, as the method sees its contacts; or motion that is measured
  /// in another frame than x, relative to or with moving supports.
  enum class Kind { contacts, other_frame };

  /// Uses the quantities of `requests` that are such. `dynamics` must outlive this object.
  SampledPeaks(Kind kind, const std::vector<model::ProbeRequest>& requests, dynamics::Dynamics& dynamics);

  void start(const time::State& state);
  void step(const time::AcceptedStep& step);
  void save(ByteWriter& to) const { to.put(largest_); }
  void restore(ByteReader& from) { from.take(largest_); }

  /// Adds the peaks by column, "mid.normal_force", to `peaks`.
  void add_to(std::map<std::string, double>& peaks) const;

 private:
  /// False if no contact of the probes can exert a force within the step.
  bool is_active() const;
  /// Takes the values at an instant of the step; they follow one another.
  void look(const time::AcceptedStep& step, double t);
  /// Looks for a maximum between the last two samples, one of which is an end of a piece.
  enum class End { first, last };
  void look_near(const time::AcceptedStep& step, End end);

  Kind kind_;
  dynamics::Dynamics& dynamics_;
  Probes::View view_;
  time::Detail detail_ = time::Detail::displacements;
  double fastest_ = 0.0;            ///< rad/s, the highest frequency of a moving frame
  std::unique_ptr<Probes> probes_;  ///< null if there are none
  std::vector<Index> contacts_;     ///< of the probes
  bool has_stops_ = false;          ///< elastic stops add to their forces
  std::vector<double> largest_, values_, now_;
  int samples_ = 0;                           ///< in the present step so far
  std::vector<std::array<Sampled, 2>> last_;  ///< for each column, the two previous samples
};

}  // namespace butee::record
