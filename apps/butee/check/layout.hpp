#pragma once

#include <optional>
#include <string>
#include <vector>

#include "survey.hpp"

namespace butee::app::check {

/// The position of a node in the picture: x in m along the beams, and the row of its beam or lone node.
struct Place {
  double x = 0.0;
  int row = 0;
};

/// A beam, or a lone node (end == begin).
struct Body {
  std::string name;
  double begin = 0.0, end = 0.0;  ///< x, m
  int row = 0;
  std::vector<double> nodes;  ///< x of its nodes, m
  bool lone = false;
};

struct SupportMark {
  Place at;
  bool u = false, theta = false;  ///< which DOFs are held
};

/// One stop. `group` indexes Layout::stop_labels.
struct StopMark {
  Place at;
  std::optional<Place> other;  ///< the second node of a stop between two nodes
  bool positive = true, negative = true;
  double gap = 0.0;  ///< m
  int group = 0;
};

struct LoadMark {
  std::vector<Place> at;
  bool moment = false;
  int sign = 0;        ///< of a load that is constant; 0 for others
  bool aside = false;  ///< beside the node, where a stop is drawn
  std::string label;
};

struct SpringMark {
  Place a;
  std::optional<Place> b;
  double stiffness = 0.0;
  bool along_z = false;
};

struct MassMark {
  Place at;
  double mass = 0.0;
};

/// A scene as plain shapes with positions, for any kind of picture. Beams that share a node continue at that
/// node; bodies that springs or stops connect lie in rows below each other, with connected nodes at the same
/// x.
struct Layout {
  std::string title;
  std::vector<Body> bodies;
  std::vector<SupportMark> supports;
  std::vector<StopMark> stops;
  std::vector<std::string> stop_labels;  ///< "gap 0.01 m, 1e+06 N/m, linear", one for each group of contacts
  std::vector<LoadMark> loads;
  std::vector<SpringMark> springs;
  std::vector<MassMark> masses;
  double left = 0.0, right = 0.0;  ///< range of x of all bodies, m
  int rows = 0;
};

/// `laws`: names of the contact laws, one for each [[contact]].
Layout layout_of(const model::Model& model, const Survey& survey, const std::vector<std::string>& laws);

/// The time function of a load, times `weight`, as short text: "300 N at 1 Hz".
std::string describe(const model::TimeFunction& function, double weight, const char* unit);

}  // namespace butee::app::check
