#include <algorithm>

#include "butee/core/text.hpp"
#include "butee/scene/scene_reader.hpp"

namespace butee::scene {

using config::number;
using config::Value;

namespace {

/// The error in a value of `modal`, regardless of its magnitude; or "".
std::string modal_complaint(const Value& given) {
  const auto ratios = config::numbers("modal", "1", "").at_least(0);
  if (given.array() != nullptr) return given.array()->empty() ? "names no mode" : ratios.complaint(given);
  if (!config::as_number(given))
    return std::string(
               "must be a number, the damping ratio of every mode, or an array of numbers, those of the lowest "
               "modes, not ") +
           given.kind();
  return number("modal", "1", "").at_least(0).complaint(given);
}

std::string modes(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " mode" : " modes");
}

}  // namespace

void SceneReader::read_damping() {
  const Value* table = root_.table()->find("damping");
  if (table == nullptr) return;
  const auto p = read_parameters(
      *table, "damping",
      {number("mass_proportional", "1/s", "Rayleigh damping by the mass matrix").at_least(0).or_else(0.0),
       number("stiffness_proportional", "s", "Rayleigh damping by the stiffness matrix").at_least(0).or_else(0.0),
       number("rotating_stiffness_proportional", "s", "of rotating parts, damping that rotates with them")
           .at_least(0)
           .or_else(0.0)},
      diagnostics_, {"modal"});
  if (p) {
    model_.rotating_damping = p->number("rotating_stiffness_proportional");
    if (model_.rotating_damping != 0.0 && root_.table()->find("rotation") == nullptr)
      p->complain(
          diagnostics_, "rotating_stiffness_proportional",
          "applies to rotating parts, but nothing turns: give [rotation] with a speed, or use stiffness_proportional");
    model_.damping.mass_proportional = p->number("mass_proportional");
    model_.damping.stiffness_proportional = p->number("stiffness_proportional");
    check_decay(*p);
  }
  const Value* modal = table->table() != nullptr ? table->table()->find("modal") : nullptr;
  if (modal == nullptr) return;
  if (table->table()->find("mass_proportional") != nullptr || table->table()->find("stiffness_proportional") != nullptr)
    diagnostics_.error("damping.modal", *modal,
                       "replaces mass_proportional and stiffness_proportional; remove it, or those");
  read_modal_damping(*modal);
}

void SceneReader::read_modal_damping(const Value& given) {
  constexpr auto kMost = static_cast<std::size_t>(Damping::kMostModes);
  const auto complain = [&](const std::string& what) { diagnostics_.error("damping.modal", given, what); };
  if (const std::string wrong = modal_complaint(given); !wrong.empty()) return complain(wrong);
  std::vector<double> ratios;
  if (given.array() == nullptr)
    ratios.push_back(*config::as_number(given));
  else
    for (const Value& ratio : *given.array()) ratios.push_back(*config::as_number(ratio));
  const auto over = std::find_if(ratios.begin(), ratios.end(), [](double ratio) { return ratio > 1.0; });
  if (over != ratios.end())
    diagnostics_.warning("damping.modal", given.at,
                         (given.array() == nullptr ? std::string()
                                                   : "the ratio " + to_short_text(*over) + " of mode " +
                                                         std::to_string(over - ratios.begin() + 1) + " ") +
                             "is more than critical damping; 2 % are written 0.02");

  const auto all = static_cast<std::size_t>(dofs_->free_count());
  if (given.array() == nullptr) {
    model_.damping.every_mode = ratios.front();
    if (all > kMost && ratios.front() > 0.0)
      complain("one ratio for every mode is for systems of at most " + std::to_string(kMost) +
               " free DOFs, and this one has " + std::to_string(all) +
               "; give an array of ratios for its lowest modes, the others are then not damped");
    return;
  }
  if (ratios.size() > kMost)
    complain("has ratios for " + modes(ratios.size()) + "; at most " + std::to_string(kMost) + " can be damped");
  else if (ratios.size() > all && !lacks_elements_)
    complain("has ratios for " + modes(ratios.size()) + ", but the scene has only " + modes(all) +
             ", one for each free DOF");
  if (std::any_of(ratios.begin(), ratios.end(), [](double ratio) { return ratio > 0.0; }))
    model_.damping.lowest_modes = std::move(ratios);
}

}  // namespace butee::scene
