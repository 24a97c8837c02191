#pragma once

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <string>

#include "butee/time/simulation.hpp"

namespace butee::record {

/// How far a run is, for people: simulated time, part done, step, closed stops, steps a second, time left.
///
/// On a terminal a bar that is drawn anew in place and taken away at the end, of a failed run too; elsewhere whole
/// lines now and then, the last at the end. The clock is looked at rarely, some tens of times a second.
class BUTEE_EXPORT Progress final : public time::Observer {
 public:
  using Clock = std::chrono::steady_clock;

  struct Style {
    bool bar = true;  ///< one line drawn in place; else a line each time
    std::FILE* stream = stderr;
    Clock::duration silence{};   ///< before the first drawing
    Clock::duration interval{};  ///< between two drawings
    int width = 80;              ///< columns that a bar may take
  };
  /// A bar on standard error where that is a terminal, else lines.
  static Style standard_style();

  /// `dynamics` must outlive it.
  Progress(dynamics::Dynamics& dynamics, double end_time, Style style = standard_style());
  ~Progress() override;
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void start(const time::State& state) override;
  void step(const time::AcceptedStep& step) override;
  void finish() override;
  void restore(ByteReader& from) override;

 private:
  void look();
  void draw(Clock::time_point now);
  std::string words(double seconds);
  Index closed_stops();
  void clear();

  dynamics::Dynamics& dynamics_;
  double end_time_;
  Style style_;
  Clock::time_point begin_, looked_, drawn_;
  double looked_t_ = 0.0;  ///< s, simulated, at the last look
  double pace_ = 0.0;      ///< simulated seconds a second, of late
  double steps_ = 0.0;     ///< those that a method took within a step included
  std::int64_t stride_ = 1, until_look_ = 1;
  bool on_screen_ = false;
  double t_ = 0.0, h_ = 0.0;
  Vector x_, displacement_, penetration_;
};

}  // namespace butee::record
