#pragma once

#include <functional>

#include "butee/scene/read_scene.hpp"
#include "butee/study/collect.hpp"
#include "butee/study/worker.hpp"

namespace butee::study {

/// The largest Lyapunov exponent of a motion, 1/s: the mean growth rate of a small disturbance (G. Benettin et al.,
/// Meccanica 15 (1980) 9-20, doi:10.1007/BF02128236).
///
/// From `start` on two runs are integrated side by side, one period at a time; at the end of each
/// their difference is rescaled to its initial size. The size of a difference is sqrt(v.M v + (2
/// pi/T)^2 x.M x). During the first quarter of the periods the difference turns into the direction
/// of fastest growth; they do not count. Nothing if a run fails or `goes_on` returns false.
std::optional<double> lyapunov_exponent(scene::Scene& scene, dynamics::Dynamics& dynamics, const Motion& start,
                                        const Counted& counted, const std::function<bool()>& goes_on);

}  // namespace butee::study
