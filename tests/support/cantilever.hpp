#pragma once

#include <string>
#include <vector>

#include <butee/core/types.hpp>

namespace butee::test {

/// The beginning of a scene: a material `steel`, a section `bar` of 30 x 60 mm and an integrator.
std::string steel_bar();

/// A cantilever `arm` of that section between two points, "[[0, 0, 0], [1, 0, 0]]", with 20 elements that
/// move in space; `up`: the direction of its height, "" for the default.
std::string cantilever(const std::string& points, const std::string& up, const std::string& theory = "euler");

/// The lowest frequencies of a scene, Hz.
std::vector<double> frequencies(const std::string& toml, Index count);

/// Expects the first entries of `found` to equal `wanted` to a relative tolerance.
void expect_all(const std::vector<double>& found, const std::vector<double>& wanted, double tolerance);

}  // namespace butee::test
