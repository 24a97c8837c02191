#pragma once

#include <optional>
#include <string>
#include <vector>

#include "butee/time/simulation.hpp"

namespace butee::record {

/// One closing of a stop.
struct Impact {
  std::string node;             ///< "a" or, of a stop between two nodes, "a|b"
  int side = 1;                 ///< +1 or -1
  double t_in = 0.0;            ///< s
  std::optional<double> t_out;  ///< s; absent while still closed
  double peak_force = 0.0;      ///< N
  double impulse = 0.0;         ///< N s
  double impact_speed = 0.0;    ///< m/s, at t_in
};

/// Finds every closing of a stop: instants by root finding on the method's interpolant, impulse by Simpson's rule.
///
/// Contacts shorter than a step are seen where they hold at the end or in the middle of it.
class BUTEE_EXPORT ImpactRecorder final : public time::Observer {
 public:
  /// `dynamics` must outlive it.
  explicit ImpactRecorder(solve::Dynamics& dynamics);

  void start(const time::State& state) override;
  void step(const time::AcceptedStep& step) override;
  bool watches_every_step() const override { return true; }
  void save(ByteWriter& to) const override;
  void restore(ByteReader& from) override;

  /// In the order of t_in, those still closed included.
  std::vector<Impact> impacts() const;
  static std::vector<std::string> columns();
  static std::string csv_line(const Impact& impact);

 private:
  /// One side of one stop.
  struct Watch {
    Index stop;
    double side, gap;
    std::vector<Index> dofs;
    bool closed = false;
    Impact current;
  };
  struct Motion {
    double penetration, speed;
  };

  Motion motion(const Watch& watch, const time::AcceptedStep& step, double t) const;
  Motion motion(const Watch& watch, const time::State& state) const;
  double crossing(const Watch& watch, const time::AcceptedStep& step, double begin, double end) const;
  void follow(Watch& watch, const time::AcceptedStep& step, double begin, double end);
  void accumulate(Watch& watch, const time::AcceptedStep& step, double begin, double end);
  double force(const Watch& watch, double penetration);

  solve::Dynamics& dynamics_;
  std::vector<Watch> watches_;
  std::vector<Impact> done_;
};

}  // namespace butee::record
