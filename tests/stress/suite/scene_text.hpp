#pragma once

#include <string>

#include <butee/core/text.hpp>

namespace butee::stress {

inline constexpr double kQuarterTurn = 1.5707963267948966;

inline std::string mass_text(const std::string& name, double mass) {
  return "[[element]]\ntype = \"mass\"\nname = \"" + name + "\"\nmass = " + to_text(mass) + "\n";
}

/// `ends`: the TOML line with its node or nodes.
inline std::string spring_text(const std::string& ends, double stiffness, double damping) {
  return "[[element]]\ntype = \"spring\"\n" + ends + "stiffness = " + to_text(stiffness) +
         "\ndamping = " + to_text(damping) + "\n";
}

}  // namespace butee::stress
