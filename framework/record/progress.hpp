#pragma once

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <string>

#include "butee/time/simulation.hpp"

namespace butee::record {

/// The progress of a run for the user: simulated time, fraction done, step, closed stops, steps per
/// second, time left.
///
/// On a terminal a bar that is redrawn in place and removed at the end, also of a failed run;
/// otherwise whole lines from time to time, the last at the end. The clock is read only some tens
/// of times a second.
class BUTEE_EXPORT Progress final : public time::Observer {
 public:
  using Clock = std::chrono::steady_clock;

  struct Style {
    bool bar = true;  ///< one line drawn in place; otherwise a new line each time
    std::FILE* stream = stderr;
    Clock::duration silence{};   ///< before the first drawing
    Clock::duration interval{};  ///< between two drawings
    int width = 80;              ///< maximum width of a bar, columns
  };
  /// A bar on standard error if that is a terminal, else lines.
  static Style standard_style();

  /// `dynamics` must outlive this object.
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
  double looked_t_ = 0.0;  ///< s, simulated time at the last check
  double pace_ = 0.0;      ///< recent rate, simulated seconds per second
  double steps_ = 0.0;     ///< including internal steps of a method
  std::int64_t stride_ = 1, until_look_ = 1;
  bool on_screen_ = false;
  double t_ = 0.0, h_ = 0.0;
  Vector x_, displacement_, penetration_;
};

}  // namespace butee::record
