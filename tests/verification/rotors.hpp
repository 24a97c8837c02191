#pragma once

#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include <butee/dynamics/whirl.hpp>
#include <gtest/gtest.h>

/// Scenes of shafts with discs and bearings.
namespace butee::test::rotors {

using std::numbers::pi;

/// The references have 8 to 10 printed digits.
constexpr double kPrinted = 2e-8;
constexpr double kRpm = pi / 30.0;

inline std::string steel(const std::string& theory, int elements, double length, double radius,
                         const std::string& material) {
  return R"(
schema = 1
[material.steel]
)" + material +
         R"(
[section.round]
shape  = "circle"
radius = )" +
         std::to_string(radius) + R"(
[[element]]
type     = "beam"
name     = "shaft"
motion   = "lateral"
theory   = ")" +
         theory + R"("
material = "steel"
section  = "round"
length   = )" +
         std::to_string(length) + R"(
elements = )" +
         std::to_string(elements) + "\n";
}

inline std::string disc(const std::string& at, double mass, double diametral, double polar) {
  std::ostringstream text;
  text.precision(17);
  text << "[[element]]\ntype = \"disc\"\nnode = \"shaft" << at << "\"\nmass = " << mass
       << "\ndiametral_inertia = " << diametral << "\npolar_inertia = " << polar << "\n";
  return text.str();
}

inline std::string bearing(const std::string& at, double kyy, double kzz, double cyy = 0.0, double czz = 0.0) {
  std::ostringstream text;
  text.precision(17);
  text << "[[element]]\ntype = \"bearing\"\nnode = \"shaft" << at << "\"\nstiffness = [[" << kyy << ", 0], [0, " << kzz
       << "]]\ndamping = [[" << cyy << ", 0], [0, " << czz << "]]\n";
  return text.str();
}

inline std::string turning(double speed) {
  std::ostringstream text;
  text.precision(17);
  text << "[rotation]\nspeed = " << speed << "\n[integrator]\ntype = \"rk4\"\ntime_step = 1e-6\nend_time = 1e-3\n";
  return text.str();
}

inline std::vector<double> frequencies(const std::vector<dynamics::WhirlMode>& modes) {
  std::vector<double> list;
  for (const auto& mode : modes) list.push_back(mode.frequency());
  return list;
}

inline void expect_all(const std::vector<double>& found, const std::vector<double>& wanted, double unit,
                       double tolerance) {
  ASSERT_GE(found.size(), wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i)
    EXPECT_NEAR(found[i], wanted[i] * unit, tolerance * wanted[i] * unit) << "mode " << i + 1;
}

}  // namespace butee::test::rotors
