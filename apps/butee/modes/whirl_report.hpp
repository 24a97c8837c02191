#pragma once

#include <string>
#include <vector>

#include <butee/dynamics/whirl.hpp>
#include <butee/record/result_folder.hpp>

#include "../json.hpp"

namespace butee::app::modes {

/// The damped modes of a structure at one speed of rotation.
struct WhirlAnalysis {
  std::string title;
  Index dofs = 0;
  double speed = 0.0;  ///< rad/s
  double sense = 0.0;  ///< sign of forward whirl: that of the speed; at rest +1 with cross terms, otherwise 0
  std::vector<dynamics::WhirlMode> modes;
};

/// The damped modes over a range of speeds, and the critical speeds in it.
struct Campbell {
  std::string title;
  double order = 1.0;
  std::vector<double> speeds;  ///< rad/s
  std::vector<double> senses;  ///< the sign of forward whirl at each speed; 0 where it is undefined
  std::vector<std::vector<dynamics::WhirlMode>> modes;
  std::vector<dynamics::CriticalSpeed> critical;
  std::vector<dynamics::StabilityBorder> borders;
  bool grows_at_first = false;  ///< a mode grows at the first speed
  Index examined = 0;           ///< the number of lowest modes that were examined; 0: all
};

/// Oscillating modes at a speed, rad/s.
WhirlAnalysis whirl_at(const dynamics::Whirl& whirl, const std::string& title, double speed, Index count);
/// Modes at `steps` + 1 speeds from `from` to `to`, rad/s.
Campbell campbell(const dynamics::Whirl& whirl, const std::string& title, double from, double to, Index steps,
                  double order, Index count);

void print(const WhirlAnalysis& analysis);
void print(const Campbell& diagram);
Json to_json(const WhirlAnalysis& analysis);
Json to_json(const Campbell& diagram);
/// Writes one row for each speed and mode.
std::string campbell_csv(const Campbell& diagram);
/// Writes campbell.gp and draws campbell.png and .svg by gnuplot; returns false if gnuplot failed.
bool draw(const Campbell& diagram, const record::ResultFolder& folder);

}  // namespace butee::app::modes
