#pragma once

#include <string>
#include <vector>

#include "scenes.hpp"

namespace butee::stress {

/// A structure to which stops and loads are added.
struct Body {
  std::string toml;
  std::vector<std::string> nodes;    ///< selectors of the nodes that can move
  std::vector<std::string> turning;  ///< of these, the nodes that can rotate
  double omega = 100.0;              ///< rad/s, frequency of the slow motion
  double stiffness = 1e4;            ///< N/m, stiffness against a force on the last node
  double mass = 1.0;                 ///< kg, mass that moves with it
  double size = 1e-2;                ///< m, size of the motion
  bool is_free = false;              ///< a part can move without elastic forces
};

/// A random element of `all`.
const std::string& any_of(const std::vector<std::string>& all, Random& random);

/// Masses in a row; some may be light, down to 1e-8 of the others.
Body row_of_masses(Random& random);
/// One to three beams in series, with discs, and with springs and dashpots on their ends and rotations.
Body beams(Random& random);
/// A mass on a weak spring that moves between stops of 1e4 to 1e8 times the spring's stiffness.
Body flight(Random& random);
/// Adds a lone mass "n" beside a beam, which it may strike; it is tied to ground by a spring or free.
void add_neighbour(Body& body, Random& random);

}  // namespace butee::stress
