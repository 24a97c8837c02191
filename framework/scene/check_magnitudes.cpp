#include <cmath>
#include <limits>
#include <set>

#include "butee/core/text.hpp"
#include "butee/scene/scene_reader.hpp"

namespace butee::scene {

namespace {

/// The highest rate of a DOF, 1/s; that of atoms in steel is 1e14. Beyond it results are rounding, or overflow.
constexpr double kFastest = 1e20;
/// A scene is refused if rounding of a sum may take this part of the stiffness of an element.
constexpr double kLost = 1e-2;
/// The part above which there is a warning, and that which the advised stiffness leaves.
constexpr double kWorn = 1e-4, kAdvised = 1e-6;

std::string with_unit(double value, DofKind kind, const char* of_motion, const char* of_rotation) {
  return to_short_text(value) + " " + (is_rotation(kind) ? of_rotation : of_motion);
}

std::string of_stiffness(double value, DofKind kind) {
  return with_unit(value, kind, "N/m", "N m/rad");
}

std::string in_percent(double part) {
  return to_short_text(100.0 * part, 2) + " %";
}

}  // namespace

void SceneReader::check_magnitudes() {
  sums_.emplace(*dofs_);
  for (std::size_t i = 0; i < model_.elements.size(); ++i) {
    sums_->begin_element(i);
    model_.elements[i]->assemble(*sums_);
  }
  const auto complain = [&](std::size_t element, const std::string& complaint) {
    diagnostics_.error(element_places_[element].first, element_places_[element].second, complaint);
  };
  for (const std::size_t element : sums_->not_finite())
    complain(element,
             "its matrices have entries that are not finite: check its lengths, section and material, in SI units");
  std::set<std::size_t> reported;
  for (std::size_t i = 0; i < sums_->sums().size() && sums_->not_finite().empty(); ++i) {
    const ElementSums::Sum& sum = sums_->sums()[i];
    const model::NodalDof dof = dofs_->free()[i];
    const std::string place = dofs_->name(dof),
                      beside = " beside " + with_unit(sum.mass, dof.kind, "kg", "kg m2") + " there";
    if (const double rate = std::sqrt(sum.stiffness / sum.mass);
        rate > kFastest && reported.insert(sum.stiffest.element).second)
      complain(sum.stiffest.element, "its stiffness of " + of_stiffness(sum.stiffest.value, dof.kind) + " on " + place +
                                         beside + " oscillates faster than " + to_short_text(kFastest) +
                                         " rad/s, the most that can be computed: check its values, in SI units");
    if (const double rate = sum.damping / sum.mass; rate > kFastest && reported.insert(sum.most_damped.element).second)
      complain(sum.most_damped.element, "its damping of " +
                                            with_unit(sum.most_damped.value, dof.kind, "N s/m", "N m s/rad") + " on " +
                                            place + beside + " decays faster than " + to_short_text(kFastest) +
                                            " 1/s, the most that can be computed: check its values, in SI units");
    const double lost = 0.5 * std::numeric_limits<double>::epsilon() * sum.stiffness / sum.softest.value;
    if (!(lost > kWorn) || sum.softest.value == 0.0 || !reported.insert(sum.softest.element).second) continue;
    const auto& [path, at] = element_places_[sum.softest.element];
    const std::string complaint = "its stiffness of " + of_stiffness(sum.softest.value, dof.kind) + " on " + place +
                                  " is added to " + of_stiffness(sum.stiffest.value, dof.kind) + " of " +
                                  element_places_[sum.stiffest.element].first + ", and double precision " +
                                  (lost < 1.0 ? "may lose " + in_percent(lost) + " of it" : "loses it") +
                                  ": join the nodes or fix them instead, or make the stiffer one at most " +
                                  of_stiffness(kAdvised / lost * sum.stiffest.value, dof.kind);
    if (lost > kLost)
      diagnostics_.error(path, at, complaint);
    else
      diagnostics_.warning(path, at, complaint);
  }
}

void SceneReader::check_rate(const config::Parameters& parameters, const std::string& key, double stiffness,
                             const std::vector<NodeId>& nodes, const std::vector<DofKind>& directions) {
  if (!sums_) return;
  for (const NodeId node : nodes)
    for (const DofKind kind : directions) {
      const Index at = dofs_->index({node, kind});
      if (at < 0) continue;
      const double mass = sums_->sums()[static_cast<std::size_t>(at)].mass, rate = std::sqrt(stiffness / mass);
      if (!(rate > kFastest)) continue;
      const std::string complaint = "a closed contact of " + of_stiffness(stiffness, kind) + " on " +
                                    dofs_->name({node, kind}) + " beside " + with_unit(mass, kind, "kg", "kg m2") +
                                    " there oscillates faster than " + to_short_text(kFastest) +
                                    " rad/s, the most that can be computed: check the values, in SI units";
      if (parameters.given(key))
        parameters.complain(diagnostics_, key, complaint);
      else
        diagnostics_.error(parameters.path(), parameters.at(), complaint);
      return;
    }
}

void SceneReader::check_decay(const config::Parameters& parameters) {
  if (!sums_) return;
  double square = 0.0;
  for (const ElementSums::Sum& sum : sums_->sums()) square = std::max(square, sum.stiffness / sum.mass);
  if (model_.damping.stiffness_proportional * square > kFastest)
    parameters.complain(diagnostics_, "stiffness_proportional",
                        "damps motion faster than " + to_short_text(kFastest) +
                            " 1/s, the most that can be computed; it is in seconds, such as 1e-6");
  if (model_.damping.mass_proportional > kFastest)
    parameters.complain(diagnostics_, "mass_proportional",
                        "at most " + to_short_text(kFastest) + " 1/s can be computed; it is in 1/s, such as 1");
}

}  // namespace butee::scene
