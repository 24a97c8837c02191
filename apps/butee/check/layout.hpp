#pragma once

#include <optional>
#include <string>
#include <vector>

#include "survey.hpp"

namespace butee::app::check {

/// A node's place in the picture: x in m along the beams, and the row that its beam or lone node has.
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
  bool u = false, theta = false;  ///< what is held
};

/// One stop. `group` indexes Layout::stop_labels.
struct StopMark {
  Place at;
  std::optional<Place> other;  ///< of a stop between two nodes
  bool positive = true, negative = true;
  double gap = 0.0;  ///< m
  int group = 0;
};

struct LoadMark {
  std::vector<Place> at;
  bool moment = false;
  std::string label;
};

struct SpringMark {
  Place a;
  std::optional<Place> b;
  double stiffness = 0.0;
};

struct MassMark {
  Place at;
  double mass = 0.0;
};

/// A scene as plain shapes with places, for any kind of picture. Beams that share nodes go on at the shared node;
/// bodies that springs or stops tie together lie one below the other, the tied nodes above each other.
struct Layout {
  std::string title;
  std::vector<Body> bodies;
  std::vector<SupportMark> supports;
  std::vector<StopMark> stops;
  std::vector<std::string> stop_labels;  ///< "gap 0.01 m, linear, 1e6 N/m", one for each [[contact]]
  std::vector<LoadMark> loads;
  std::vector<SpringMark> springs;
  std::vector<MassMark> masses;
  double left = 0.0, right = 0.0;  ///< x of all bodies, m
  int rows = 0;
};

/// `laws` are the names of the stops' laws, one for each group.
Layout layout_of(const model::Model& model, const Survey& survey, const std::vector<std::string>& laws);

/// The time course of a load in a few words: "300 cos(6.28 t)", from a pattern of a single unit of `unit`.
std::string describe(const model::TimeFunction& function, double weight, const char* unit);

}  // namespace butee::app::check
