#include "report.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <set>

#include <butee/core/format.hpp>
#include <butee/core/text.hpp>
#include <butee/dynamics/free_motion.hpp>
#include <butee/dynamics/modal_damping.hpp>

namespace butee::app::check {
namespace {

/// Number of entries printed from a list of damped modes.
constexpr Index kListedModes = 10;
constexpr double kTwoPi = 2.0 * std::numbers::pi;

/// Nodes; two names of one node count once.
int node_count(const model::NodeTable& nodes) {
  int count = 0;
  for (model::NodeId node = 0; node < nodes.size(); ++node) count += nodes.canonical(node) == node ? 1 : 0;
  return count;
}

Index stop_count(const model::System& system) {
  Index stops = 0;
  for (const auto& group : system.stops) stops += static_cast<Index>(group.size());
  for (const auto& group : system.obstacles) stops += static_cast<Index>(group.ends.size());
  return stops;
}

void print_contents(const model::Model& model, const model::System& system, const Survey& survey) {
  std::printf("scene      %s\n", model.title.empty() ? "(without a title)" : printable(model.title).c_str());
  const int nodes = node_count(model.nodes);
  std::printf("elements   %zu on %d %s\n", model.elements.size(), nodes, nodes == 1 ? "node" : "nodes");
  std::printf("mass       %s kg", to_short_text(survey.total_mass).c_str());
  if (survey.lumped_mass > 0.0) std::printf(", of it %s kg on single nodes", to_short_text(survey.lumped_mass).c_str());
  std::printf("\nDOFs       %td free, %td fixed\n", system.size(), system.dofs.fixed_count());
  std::printf("stops      %td on free DOFs\n", stop_count(system));
  std::printf("loads      %zu\n", model.loads.size());
}

/// `modal` as text: the damping ratios and, if they are a list, the frequencies of their modes.
void print_modal_damping(const model::System& system) {
  const model::Damping& damping = system.damping;
  (void)dynamics::ModalDamping::of(system);  // Throws if a run would.
  if (damping.every_mode != 0.0)
    std::printf("damping    modal: the ratio %s in all %td modes\n", to_short_text(damping.every_mode).c_str(),
                system.size());
  if (damping.lowest_modes.empty()) return;
  const auto count = static_cast<Index>(damping.lowest_modes.size());
  const auto modes = dynamics::lowest_modes(system, count);
  std::printf("damping    modal: ratios in the %td lowest modes, none in the %td above%s\n", count,
              system.size() - count, modes ? "" : " (the eigenvalue solver did not converge)");
  for (Index i = 0; modes && i < std::min(count, kListedModes); ++i)
    std::printf("           %s at %s rad/s%s\n",
                to_short_text(damping.lowest_modes[static_cast<std::size_t>(i)]).c_str(),
                to_short_text(modes->frequencies[i]).c_str(), modes->frequencies[i] == 0.0 ? " (rigid motion)" : "");
  if (count > kListedModes) std::printf("           ... and %td more\n", count - kListedModes);
}

/// Parts of the scene that the system ignores, and motions and loads that a run leaves out.
std::vector<std::string> skipped(const scene::Scene& session, const model::System& system) {
  std::vector<std::string> lines;
  if (system.skipped_stops > 0)
    lines.push_back(std::to_string(system.skipped_stops) + " stops whose ends are all fixed: they are left out");
  if (system.skipped_loads > 0)
    lines.push_back(std::to_string(system.skipped_loads) +
                    " loads that are zero at all times or act only on fixed DOFs");
  if (system.loads.empty()) lines.emplace_back("loads: nothing drives the free DOFs");
  if (system.stops.empty() && system.obstacles.empty())
    lines.emplace_back("contact: the scene has no stops, so an implicit method factorizes once for each step size");
  if (!system.damping.is_rayleigh() && !system.damping.is_modal() && system.dashpots.size() == 0)
    lines.emplace_back("damping: C is zero");
  else if (!system.damping.is_modal() && system.dashpots.size() == 0)
    lines.emplace_back("a damping matrix: C is Rayleigh's, made of M and K");
  if (!session.output.energy) lines.emplace_back("the energy balance: [output] does not request energy");
  if (!session.output.impacts) lines.emplace_back("the list of impacts: [output] does not request impacts");
  const plugin::IntegratorEntry* chosen = session.catalogue.find(session.integrator.name);
  std::set<std::string> others;
  for (const plugin::IntegratorEntry& entry : session.catalogue.integrators())
    if (entry.module != chosen->module) others.insert(entry.module);
  if (!others.empty())
    lines.push_back(std::to_string(others.size()) + " modules of other methods: they are not loaded");
  return lines;
}

/// "3 ... 4", or "3" if both print alike.
std::string span(double low, double high) {
  const std::string first = to_short_text(low), last = to_short_text(high);
  return first == last ? first : first + " ... " + last;
}

void print_range(const char* label, const std::optional<dynamics::FrequencyRange>& range) {
  if (!range) {
    std::printf("%s (the eigenvalue solver did not converge)\n", label);
    return;
  }
  std::printf("%s %s rad/s (%s Hz)\n", label, span(range->lowest, range->highest).c_str(),
              span(range->lowest / kTwoPi, range->highest / kTwoPi).c_str());
}

void print_step(const scene::Scene& session, const Facts& facts) {
  const scene::IntegratorChoice& choice = session.integrator;
  const double h = choice.options.time_step;
  if (const auto& one = facts.of_runge_kutta, &other = facts.of_central_differences; one && other)
    std::printf(
        "critical   step of classical Runge-Kutta %s s (stops open), %s s (all closed); of central differences %s s, "
        "%s s\n",
        to_short_text(one->open).c_str(), to_short_text(one->closed).c_str(), to_short_text(other->open).c_str(),
        to_short_text(other->closed).c_str());
  if (h == 0.0) {
    std::printf("method     %s, which chooses its own steps\n", choice.name.c_str());
    return;
  }
  std::printf("method     %s, time_step %s s\n", choice.name.c_str(), to_short_text(h).c_str());
  if (!facts.of_method)
    std::printf(
        "           stable at every step for linear motion; %s steps in the shortest period with all stops closed\n",
        to_short_text(kTwoPi / (facts.closed->highest * h)).c_str());
  else if (h <= facts.of_method->closed)
    std::printf("           below its critical step by a factor of %s\n",
                to_short_text(facts.of_method->closed / h).c_str());
}

void print_play(const std::optional<Mechanics::Play>& play, const char* kind, const char* unit) {
  if (play && play->static_deflection && play->smallest_gap > 0.0)
    std::printf("static     the static %s at a stop under the load amplitudes is %s %s; the smallest gap is %s %s\n",
                kind, to_short_text(*play->static_deflection).c_str(), unit, to_short_text(play->smallest_gap).c_str(),
                unit);
}

void print_mechanics(const Mechanics& mechanics) {
  if (mechanics.sampled == 0) return;
  if (mechanics.least_ratio)
    std::printf("stiffness  of a closed stop: %s times that of the structure where it acts\n",
                span(*mechanics.least_ratio, *mechanics.largest_ratio).c_str());
  if (std::isfinite(mechanics.shortest_contact))
    std::printf("contact    an impact lasts about %s s or longer\n", to_short_text(mechanics.shortest_contact).c_str());
  print_play(mechanics.displacements, "displacement", "m");
  print_play(mechanics.rotations, "rotation", "rad");
}

std::string size_of(double bytes) {
  if (bytes < 1e6) return formatted("%.0f kB", std::max(1.0, bytes / 1e3));
  return bytes < 1e9 ? formatted("%.0f MB", bytes / 1e6) : formatted("%.1f GB", bytes / 1e9);
}

void print_cost(const Estimate& cost, bool trust) {
  if (!cost.choice.empty()) std::printf("chosen     %s\n", cost.choice.c_str());
  const std::string steps =
      cost.steps ? formatted(cost.whole || cost.steps_known ? "%.0f steps" : "about %.2g steps", *cost.steps) : "";
  const bool has_trial = cost.failure.empty() && cost.refusal.empty();
  if (has_trial && cost.seconds)
    std::printf("estimate   %s%.2g s in all%s, %s (%s)\n", cost.whole ? "" : "about ", *cost.seconds,
                trust ? " without trust" : "", steps.c_str(),
                cost.whole ? "from a complete trial run" : "from a short trial");
  else if (has_trial)
    std::printf(
        "estimate   none: a trial of %.2g s covered %.2g %% of the time, and its pace is no guide to the rest%s%s\n",
        cost.trial_seconds, 100.0 * cost.part,
        cost.part > 0.0 ? formatted("; the same pace would take %.2g s", cost.trial_seconds / cost.part).c_str() : "",
        steps.empty() ? "" : ("; " + steps).c_str());
  if (cost.rows) std::printf("results    %.4g rows, about %s\n", *cost.rows, size_of(*cost.bytes).c_str());
}

Json json_of(const std::optional<dynamics::FrequencyRange>& range) {
  if (!range) return {};
  Json json;
  json["lowest"] = range->lowest;
  json["highest"] = range->highest;
  return json;
}

Json json_of(const std::optional<double>& value) {
  return value ? Json(*value) : Json();
}

Json json_of(const Mechanics& mechanics) {
  Json json;
  if (mechanics.sampled == 0) return json;
  json["least_stiffness_ratio"] = json_of(mechanics.least_ratio);
  json["largest_stiffness_ratio"] = json_of(mechanics.largest_ratio);
  json["shortest_contact"] = mechanics.shortest_contact;
  if (mechanics.displacements) {
    json["smallest_gap"] = mechanics.displacements->smallest_gap;
    json["static_deflection"] = json_of(mechanics.displacements->static_deflection);
  }
  if (mechanics.rotations) {
    json["smallest_gap_of_rotation"] = mechanics.rotations->smallest_gap;
    json["static_rotation"] = json_of(mechanics.rotations->static_deflection);
  }
  return json;
}

}  // namespace

void print(const scene::Scene& session, const model::System& system, const Facts& facts, const std::string& picture) {
  print_contents(session.model, system, facts.survey);
  print_modal_damping(system);
  if (!picture.empty()) std::printf("\n%s\n", picture.c_str());
  for (const std::string& line : skipped(session, system)) std::printf("skips      %s\n", line.c_str());
  const bool has_stops = !system.stops.empty() || !system.obstacles.empty();
  print_range(has_stops ? "frequency  all stops open:  " : "frequency ", facts.open);
  if (has_stops) print_range("           all stops closed:", facts.closed);
  if (facts.open && facts.closed) {
    print_step(session, facts);
    if (facts.open->lowest == 0.0)
      std::printf(
          "free       with all stops open the lowest frequency is 0 up to rounding: a rigid body, a mechanism, or an "
          "unstable structure: %s\n",
          dynamics::describe_softest_motion(system.stiffness, system.dofs).c_str());
  }
  print_mechanics(facts.mechanics);
  print_cost(facts.cost, session.output.trust);
  std::fflush(stdout);
}

Json to_json(const scene::Scene& session, const model::System& system, const Facts& facts,
             const std::vector<Advice>& advice) {
  Json json;
  json["title"] = session.model.title;
  json["elements"] = session.model.elements.size();
  json["nodes"] = node_count(session.model.nodes);
  json["mass"] = facts.survey.total_mass;
  json["free_dofs"] = system.size();
  json["fixed_dofs"] = system.dofs.fixed_count();
  json["stops"] = stop_count(system);
  json["loads"] = session.model.loads.size();
  json["skipped"] = skipped(session, system);
  json["angular_frequency"] = {{"open", json_of(facts.open)}, {"closed", json_of(facts.closed)}};
  if (facts.of_runge_kutta && facts.of_central_differences)
    json["critical_step"] = {{"runge_kutta_4", facts.of_runge_kutta->closed},
                             {"central_differences", facts.of_central_differences->closed}};
  json["method"] = session.integrator.name;
  json["chosen"] = facts.cost.choice.empty() ? Json() : Json(facts.cost.choice);
  json["time_step"] = session.integrator.options.time_step;
  json["end_time"] = session.integrator.options.end_time;
  json["contact"] = json_of(facts.mechanics);
  const Estimate& cost = facts.cost;
  json["refused"] = cost.refusal.empty() ? Json() : Json(cost.refusal);
  json["estimate"] = {{"seconds", json_of(cost.seconds)},
                      {"steps", json_of(cost.steps)},
                      {"whole", cost.whole},
                      {"rows", json_of(cost.rows)},
                      {"bytes", json_of(cost.bytes)}};
  json["warnings"] = Json::array();
  for (const Advice& item : advice) json["warnings"].push_back({{"about", item.about}, {"text", item.text}});
  return json;
}

}  // namespace butee::app::check
