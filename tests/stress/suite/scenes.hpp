#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace butee::stress {

/// A scene without a method.
struct Scene {
  std::string name;          ///< describes the scene and allows it to be made again
  std::string toml;          ///< all tables except [integrator]
  double end_time = 0.0;     ///< s
  double tolerance = 1e-4;   ///< of methods with error control; also the size of disturbances for the trust horizon
  double step_factor = 0.1;  ///< fixed steps, in critical steps of central differences with all stops closed
  double size = 1e-3;        ///< m, approximate size of its motion
};

/// Reproducible everywhere: the 64-bit SplitMix generator.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::uint64_t next();
  double uniform(double low, double high);
  /// 10 to a uniformly distributed power.
  double decades(double low, double high);
  bool chance(double probability) { return uniform(0.0, 1.0) < probability; }
  int integer(int low, int high);

 private:
  std::uint64_t state_;
};

/// A random scene: one to three masses, two bodies with a stop between them, or a short beam.
Scene random_scene(std::uint64_t seed);

/// Corners of the parameter space one after the other: stiffness, gap, lambda, damping, step, masses,
/// resonance, stops without a gap, stops closed at the start, discontinuous loads. `points`: number of points
/// of each sweep.
std::vector<Scene> corner_scenes(int points);

}  // namespace butee::stress
