#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>
#include <string>

#include <Eigen/SparseCholesky>
#include <butee/core/log.hpp>
#include <butee/core/text.hpp>
#include <butee/solve/free_motion.hpp>
#include <butee/solve/frequencies.hpp>
#include <butee/solve/modal_damping.hpp>

#include "commands.hpp"

namespace butee::app {
namespace {

/// The arctan law's pull is warned of where it moves the structure by more than this fraction of the gap.
constexpr double kNoticeablePull = 1e-6;

/// A frequency below this fraction of the highest is zero within the rounding of the eigenvalue solver.
constexpr double kZeroFrequency = 1e-6;

/// Of a list of damped modes, so many are printed.
constexpr Index kListedModes = 10;

std::string text(double value) {
  return to_short_text(value);
}

void print_contents(const model::Model& model, const model::System& system) {
  std::size_t loads = model.loads.size();
  Index stops = 0;
  for (const auto& group : system.stops) stops += static_cast<Index>(group.size());
  std::printf("scene      %s\n", model.title.empty() ? "(without a title)" : printable(model.title).c_str());
  std::printf("elements   %zu on %d nodes\n", model.elements.size(), model.nodes.size());
  std::printf("DOFs       %td free, %td fixed\n", system.size(), system.dofs.fixed_count());
  std::printf("stops      %td on free DOFs\n", stops);
  std::printf("loads      %zu\n", loads);
}

/// `modal` in words: the ratios and, of a list, the frequencies that they belong to.
void print_modal_damping(const model::System& system) {
  const model::Damping& damping = system.damping;
  (void)solve::ModalDamping::of(system);  // Throws where a run would.
  if (damping.every_mode != 0.0)
    std::printf("damping    modal: the ratio %s in all %td modes\n", text(damping.every_mode).c_str(), system.size());
  if (damping.lowest_modes.empty()) return;
  const auto count = static_cast<Index>(damping.lowest_modes.size());
  const auto modes = solve::lowest_modes(system, count);
  std::printf("damping    modal: ratios in the %td lowest modes, none in the %td above%s\n", count,
              system.size() - count, modes ? "" : " (the eigenvalue solver did not converge)");
  for (Index i = 0; modes && i < std::min(count, kListedModes); ++i)
    std::printf("           %s at %s rad/s%s\n", text(damping.lowest_modes[static_cast<std::size_t>(i)]).c_str(),
                text(modes->frequencies[i]).c_str(), modes->frequencies[i] == 0.0 ? " (rigid motion)" : "");
  if (count > kListedModes) std::printf("           ... and %td more\n", count - kListedModes);
}

void say_skipped(const std::string& line) {
  std::printf("skips      %s\n", line.c_str());
}

/// What the system does without, whatever the scene names.
void print_skipped_terms(const model::System& system, bool has_stops) {
  if (system.skipped_stops > 0)
    say_skipped(std::to_string(system.skipped_stops) + " stops whose ends are all fixed: they can never act");
  if (system.skipped_loads > 0)
    say_skipped(std::to_string(system.skipped_loads) + " loads that are zero at all times or act on fixed DOFs alone");
  if (system.loads.empty()) say_skipped("loads: nothing drives the free DOFs");
  if (!has_stops)
    say_skipped("contact: the scene has no stops, so an implicit method factorizes once for each step size");
  if (!system.damping.is_rayleigh() && !system.damping.is_modal() && system.dashpots.size() == 0)
    say_skipped("damping: C is zero");
  else if (!system.damping.is_modal() && system.dashpots.size() == 0)
    say_skipped("a damping matrix: C is Rayleigh's, made of M and K");
}

/// What a run of this scene does not follow, and does not load.
void print_skipped_work(const Session& session) {
  if (!session.output.energy) say_skipped("the energy balance: [output] does not ask for energy");
  if (!session.output.impacts) say_skipped("the list of impacts: [output] does not ask for impacts");
  const plugin::IntegratorEntry* chosen = session.catalogue.find(session.integrator.name);
  std::set<std::string> others;
  for (const plugin::IntegratorEntry& entry : session.catalogue.integrators())
    if (entry.module != chosen->module) others.insert(entry.module);
  if (!others.empty()) say_skipped(std::to_string(others.size()) + " modules of other methods: they are not loaded");
}

void print_range(const char* label, const std::optional<solve::FrequencyRange>& range) {
  constexpr double kTwoPi = 6.283185307179586;
  if (!range) {
    std::printf("%s (the eigenvalue solver did not converge)\n", label);
    return;
  }
  std::printf("%s %s ... %s rad/s (%s ... %s Hz)\n", label, text(range->lowest).c_str(), text(range->highest).c_str(),
              text(range->lowest / kTwoPi).c_str(), text(range->highest / kTwoPi).c_str());
}

void print_step(const plugin::IntegratorChoice& choice, const time::IntegratorType& type, double open, double closed) {
  const double h = choice.options.time_step;
  constexpr double kRungeKutta4 = 2.8284271247461903, kCentralDifferences = 2.0;
  std::printf(
      "critical   step of classical Runge-Kutta %s s (stops open), %s s (all closed); of central differences %s s, %s "
      "s\n",
      text(kRungeKutta4 / open).c_str(), text(kRungeKutta4 / closed).c_str(), text(kCentralDifferences / open).c_str(),
      text(kCentralDifferences / closed).c_str());
  if (h == 0.0) {
    std::printf("method     %s, which finds its steps itself\n", choice.name.c_str());
    return;
  }
  std::printf("method     %s, time_step %s s\n", choice.name.c_str(), text(h).c_str());
  if (std::isinf(type.stability_limit)) {
    std::printf(
        "           stable at every step for linear motion; %s steps in the shortest period with all stops closed\n",
        text(6.283185307179586 / (closed * h)).c_str());
  } else if (h > type.stability_limit / closed) {
    log::warning("time_step = " + text(h) + " s is larger than the critical step of " + choice.name + ", " +
                 text(type.stability_limit / closed) + " s with all stops closed" +
                 (h > type.stability_limit / open ? " and also with all stops open" : "") +
                 ": the solution would grow without bound; take a smaller step or an implicit method");
  } else {
    std::printf("           below its critical step by a factor of %s\n",
                text(type.stability_limit / (closed * h)).c_str());
  }
}

/// The largest displacement that the pull of all open stops together gives the structure at rest; nothing where K is
/// singular.
std::optional<double> pull_displacement(const model::System& system) {
  Vector force = Vector::Zero(system.size());
  for (const auto& stops : system.stops)
    for (std::size_t i = 0; i < stops.size(); ++i) {
      if (stops.a[i] >= 0) force[stops.a[i]] += stops.law->far_force();
      if (stops.b[i] >= 0) force[stops.b[i]] -= stops.law->far_force();
    }
  const Eigen::SimplicialLDLT<SparseMatrix> factor(system.stiffness);
  if (factor.info() != Eigen::Success || factor.vectorD().minCoeff() <= 0.0) return std::nullopt;
  return factor.solve(force).lpNorm<Eigen::Infinity>();
}

void warn_of_pull(const model::System& system) {
  double pull = 0.0, smallest_gap = std::numeric_limits<double>::infinity();
  bool at_rest = false;
  for (const auto& stops : system.stops) {
    if (stops.law->far_force() == 0.0) continue;
    pull = std::max(pull, stops.law->far_force());
    smallest_gap = std::min(smallest_gap, stops.gap);
    for (std::size_t i = 0; i < stops.size() && stops.sides == model::Sides::both; ++i) {
      const double ua = stops.a[i] >= 0 ? system.initial_displacement[stops.a[i]] : 0.0;
      const double ub = stops.b[i] >= 0 ? system.initial_displacement[stops.b[i]] : 0.0;
      at_rest = at_rest || ua == ub;
    }
  }
  if (pull == 0.0) return;
  const auto moved = pull_displacement(system);
  if (!moved || *moved > kNoticeablePull * smallest_gap)
    log::warning("the arctan law pulls every open stop with up to " + text(pull) + " N however far it is open" +
                 (moved ? "; all together move the structure at rest by " + text(*moved) + " m, " +
                              text(*moved / smallest_gap) + " of the gap"
                        : "") +
                 ". A larger regularization weakens it, law = \"linear\" has none");
  if (at_rest)
    log::warning("with the arctan law the force of a stop on both sides jumps by " + text(2.0 * pull) +
                 " N at u = 0, where this scene starts: which way it is pulled is decided by rounding, and answers are "
                 "reproducible "
                 "only so far. law = \"linear\" has no jump");
}

int check_command(const ModelArguments& arguments) {
  Session session = open_session(arguments);
  const model::System system = assemble(session.model);
  const bool has_stops = !system.stops.empty();
  print_contents(session.model, system);
  print_modal_damping(system);
  print_skipped_terms(system, has_stops);
  print_skipped_work(session);

  const auto open = frequency_range(system, solve::StopState::open);
  const auto closed = has_stops ? frequency_range(system, solve::StopState::closed) : open;
  print_range(has_stops ? "frequency  all stops open:  " : "frequency ", open);
  if (has_stops) print_range("           all stops closed:", closed);
  if (open && closed) {
    const plugin::IntegratorChoice& choice = session.integrator;
    print_step(choice, session.catalogue.find(choice.name)->declaration, open->highest, closed->highest);
    if (open->lowest < kZeroFrequency * open->highest)
      std::printf(
          "free       with all stops open the structure can move as a rigid body or a mechanism (lowest frequency ~ "
          "0): %s\n",
          solve::describe_softest_motion(system.stiffness, system.dofs).c_str());
  }
  std::fflush(stdout);
  warn_of_pull(system);
  for (const std::string& warning : session.warnings) log::warning(warning);
  return kDone;
}

}  // namespace

Command add_check_command(CLI::App& program) {
  const auto arguments = std::make_shared<ModelArguments>();
  CLI::App* app =
      program.add_subcommand("check", "what a model holds, what it skips, its frequencies and critical steps");
  add_model_arguments(*app, *arguments);
  return {app, [arguments] { return check_command(*arguments); }};
}

}  // namespace butee::app
