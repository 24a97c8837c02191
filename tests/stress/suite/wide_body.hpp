#pragma once

#include <string>
#include <vector>

#include "scenes.hpp"

namespace butee::stress {

/// A structure that stops and loads are to be put on.
struct Body {
  std::string toml;
  std::vector<std::string> nodes;    ///< that can move, by their selectors
  std::vector<std::string> turning;  ///< of these, those that can turn
  double omega = 100.0;              ///< rad/s, of its slow motion
  double stiffness = 1e4;            ///< N/m, against a force on the last node
  double mass = 1.0;                 ///< kg, that moves with it
  double size = 1e-2;                ///< m, of its motion
  bool is_free = false;              ///< some of it moves without a spring
};

/// One of `all`.
const std::string& any_of(const std::vector<std::string>& all, Random& random);

/// Masses in a row; some parts may be light, down to 1e-8 of the others.
Body row_of_masses(Random& random);
/// One to three beams, one behind the other, with discs, and springs and dashpots on their ends and rotations.
Body beams(Random& random);
/// A mass on a weak spring that flies between stops of 1e4 to 1e8 times its stiffness.
Body flight(Random& random);
/// A lone mass "n" beside a beam, which it may strike, tied to ground by a spring or free.
void add_neighbour(Body& body, Random& random);

}  // namespace butee::stress
