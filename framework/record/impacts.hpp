#pragma once

#include <optional>
#include <string>
#include <vector>

#include "butee/record/tracks.hpp"

namespace butee::record {

/// One closing of a stop or contact.
struct Impact {
  std::size_t contact = 0;          ///< the number of the stop's side or of the contact among those recorded
  std::string node;                 ///< "a" or, for a stop between two nodes, "a|b"
  int side = 1;                     ///< +1 or -1
  double t_in = 0.0;                ///< s
  std::optional<double> t_out;      ///< s; absent while still closed
  double peak_force = 0.0;          ///< N
  double impulse = 0.0;             ///< N s
  double impact_speed = 0.0;        ///< m/s, at t_in
  double tangential_impulse = 0.0;  ///< N s, of friction, opposite to the slip
  double slip = 0.0;                ///< m, sliding distance of the contact
  double dissipated = 0.0;          ///< J
  std::string dof;                  ///< "u", "theta", "uz", ... of a stop; empty for a ring or plane
};

/// An impact without its names.
void put_impact(const Impact& impact, ByteWriter& to);
void take_impact(Impact& impact, ByteReader& from);

/// The impacts that have ended.
///
/// On the border of a stop rounding decides whether a body touches it. Impacts of one stop between which the body is
/// away for less than 1e-12 of their duration are therefore one.
class BUTEE_EXPORT ImpactList {
 public:
  void clear() { ended_.clear(); }
  /// The motion up to t, s, has been recorded: `lasting` impacts have lasted until then.
  void reach(double t) { reached_ = t; }
  /// `impact` has ended, after all others of its stop.
  void add(const Impact& impact) { append(ended_, impact, *impact.t_out); }
  /// Energy, J, that the last impact of a contact dissipated after its end, if there was one.
  void add_dissipated(std::size_t contact, double energy);
  /// With `lasting` impacts, in the order of t_in.
  std::vector<Impact> with(const std::vector<Impact>& lasting) const;

  void save(ByteWriter& to) const;
  void restore(ByteReader& from);

 private:
  /// `end`: that of the impact, or until when it has lasted, s.
  static void append(std::vector<Impact>& all, const Impact& impact, double end);

  std::vector<Impact> ended_;  ///< by t_out
  double reached_ = 0.0;
};

/// Records every closing of a stop on the method's dense output: instants by root finding, the
/// largest force at the largest penetration (StepPath), the impulse by Gauss' rule with five points
/// between such instants.
///
/// A contact shorter than a step is also detected: it reaches its largest penetration within the
/// step.
class BUTEE_EXPORT ImpactRecorder final : public time::Observer {
 public:
  /// `dynamics` must outlive this object.
  explicit ImpactRecorder(dynamics::Dynamics& dynamics);

  void start(const time::State& state) override;
  void step(const time::AcceptedStep& step) override;
  void save(ByteWriter& to) const override;
  void restore(ByteReader& from) override;

  /// In the order of t_in, including those still closed.
  std::vector<Impact> impacts() const;
  static std::vector<std::string> columns();
  static std::string csv_line(const Impact& impact);

 private:
  /// One side of one stop.
  struct Watch {
    Index stop;
    double side, gap;
    std::size_t track;
    bool closed = false;
    Impact current{};

    double penetration(const Point& point) const { return side * point.of[0] - gap; }
    double speed(const Point& point) const { return side * point.of[1]; }
  };

  /// Processes a piece between two neighbouring breakpoints.
  void follow(Watch& watch, const StepPath& path, const Point& from, const Point& to);
  /// Processes a part of a piece within which the stop opens or closes at most once.
  void follow_part(Watch& watch, const StepPath& path, const Point& from, const Point& to);
  void accumulate(Watch& watch, const StepPath& path, const Point& from, const Point& to);
  Point crossing(const Watch& watch, const StepPath& path, double begin, double end) const;
  /// The absolute force of the stop, N.
  double force(const Watch& watch, double displacement);

  dynamics::Dynamics& dynamics_;
  Tracks tracks_;
  std::vector<Watch> watches_;
  ImpactList ended_;
};

}  // namespace butee::record
