#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>

#include <butee/config/file_reference.hpp>
#include <butee/config/toml.hpp>
#include <butee/core/error.hpp>
#include <butee/core/log.hpp>
#include <butee/core/text.hpp>

#include "commands.hpp"
#include "modes/report.hpp"
#include "modes/whirl_report.hpp"

namespace butee::app {
namespace {

constexpr Index kDefaultCount = 10;

struct ModesArguments {
  ModelArguments model;
  Index count = 0;  ///< 0: kDefaultCount, or all modes of a smaller scene
  std::vector<std::string> closed;
  std::string folder;  ///< empty: no files are written, unless a plot is requested
  bool json = false, plot = false;
  std::optional<double> speed;   ///< rad/s
  std::vector<double> campbell;  ///< from, to (rad/s), number of steps
  double order = 1.0;            ///< order of the excitation for critical speeds
};

constexpr Index kMostCampbellSteps = 100000;

std::string folder_of(const ModesArguments& arguments) {
  return !arguments.folder.empty() ? arguments.folder
                                   : std::filesystem::path(arguments.model.model).stem().string() + "-modes";
}

/// Lets every part that can turn do so, in a scene without [rotation]. Throws InputError if there is none and
/// speeds other than 0 are asked for.
void let_turn(model::Model& model, bool is_at_rest) {
  if (model.rotation == nullptr) {
    model.rotation = std::make_unique<model::Rotation>(std::vector{0.0}, std::vector{0.0});
    model.turns.assign(model.elements.size(), false);
    for (std::size_t i = 0; i < model.elements.size(); ++i)
      model.turns[i] = model.elements[i]->turning() != model::Element::Turning::never &&
                       model.elements[i]->turning_problem().empty();
  }
  if (!is_at_rest && std::find(model.turns.begin(), model.turns.end(), true) == model.turns.end())
    throw InputError(
        "--speed and --campbell: nothing turns in this scene: it has no disc and no beam along x with motion = "
        "\"lateral\" or \"spatial\"");
}

/// Warns if the rounding error of the stiffness, eps sum |K_ii| |x_i|^2, is not negligible relative to x^H K
/// x of the lowest mode.
void warn_of_rounding(const dynamics::Whirl& whirl, const std::vector<dynamics::WhirlMode>& modes) {
  constexpr double kSeen = 1e-4;
  const model::System& system = whirl.system();
  for (const auto& mode : modes) {
    if (mode.frequency() == 0.0) continue;
    const double elastic = mode.shape.cwiseAbs2().dot(system.stiffness.diagonal().cwiseAbs());
    const double kinetic = std::abs(mode.shape.dot(system.mass * mode.shape)) * std::norm(mode.lambda);
    const double part = 0.5 * std::numeric_limits<double>::epsilon() * elastic / kinetic;
    if (part > kSeen)
      log::warning("rounding in the matrices of " + std::to_string(whirl.size()) +
                   " DOFs may move the lowest frequency by up to " + to_short_text(part) +
                   " of it; take fewer elements");
    return;
  }
}

int whirl_command(const ModesArguments& arguments) {
  scene::Scene session = open_session(arguments.model);
  if (!arguments.closed.empty()) throw InputError("--closed cannot be combined with --speed or --campbell");
  let_turn(session.model, arguments.campbell.empty() && arguments.speed == 0.0);
  const dynamics::Whirl whirl(session.model,
                              arguments.campbell.empty() ? dynamics::Whirl::kDense : dynamics::Whirl::kDenseSearch);
  const Index count = std::min(arguments.count > 0 ? arguments.count : kDefaultCount, 2 * whirl.size());
  if (arguments.speed && !std::isfinite(*arguments.speed))
    throw InputError("--speed: " + to_text(*arguments.speed) + " is no speed of rotation; give rad/s");
  if (arguments.campbell.empty()) {
    if (arguments.plot || !arguments.folder.empty())
      throw InputError("--speed writes no files; with -o and --plot use --campbell FROM TO N");
    const auto analysis = modes::whirl_at(whirl, session.model.title, *arguments.speed, count);
    warn_of_rounding(whirl, analysis.modes);
    if (arguments.json)
      print_json(modes::to_json(analysis));
    else
      modes::print(analysis);
    return kDone;
  }
  const double from = arguments.campbell[0], to = arguments.campbell[1], steps = arguments.campbell[2];
  if (arguments.speed) throw InputError("--speed cannot be combined with --campbell, which has its own speeds");
  if (!(from < to) || !(from >= 0.0) || !std::isfinite(to))
    throw InputError("--campbell: FROM and TO are speeds in rad/s, 0 <= FROM < TO");
  if (steps != std::floor(steps) || steps < 1 || steps > static_cast<double>(kMostCampbellSteps))
    throw InputError("--campbell: N is the number of steps between FROM and TO, 1 to " +
                     std::to_string(kMostCampbellSteps));
  const bool writes = arguments.plot || !arguments.folder.empty();
  const record::ResultFolder folder(folder_of(arguments));
  if (writes) folder.check_holds_no_run();
  const auto diagram =
      modes::campbell(whirl, session.model.title, from, to, static_cast<Index>(steps), arguments.order, count);
  if (arguments.json)
    print_json(modes::to_json(diagram));
  else
    modes::print(diagram);
  std::fflush(stdout);
  if (!writes) return kDone;
  const record::FolderLock lock = folder.lock();
  folder.prepare(config::write_toml(config::with_files_found_from(session.document, folder.path())));
  folder.write("campbell.csv", modes::campbell_csv(diagram));
  if (arguments.plot && !modes::draw(diagram, folder))
    log::warning("gnuplot could not draw; its script is " + folder.file("campbell.gp") + " (Debian: gnuplot-nox)");
  log::info("the Campbell diagram is in " + folder.path());
  return kDone;
}

void write(const modes::Analysis& analysis, const scene::Scene& session, const model::System& system,
           const ModesArguments& arguments, const record::ResultFolder& folder) {
  const record::FolderLock lock = folder.lock();
  folder.prepare(config::write_toml(config::with_files_found_from(session.document, folder.path())));
  folder.write("frequencies.csv", modes::frequencies_csv(analysis));
  folder.write("shapes.csv", modes::shapes_csv(analysis, session.model, system));
  if (arguments.plot && !modes::draw(analysis, session.model, system, folder))
    log::warning("gnuplot could not draw; its script is " + folder.file("modes.gp") + " (Debian: gnuplot-nox)");
  log::info("shapes in " + folder.path());
}

int modes_command(const ModesArguments& arguments) {
  if (arguments.speed || !arguments.campbell.empty()) return whirl_command(arguments);
  const scene::Scene session = open_session(arguments.model);
  const model::System system = assemble(session.model);
  if (!system.stiffness_is_symmetric)
    throw InputError(
        "the stiffness matrix is not symmetric, because of cross terms of bearings or of given matrices, or of damping "
        "that turns, so that the "
        "scene has no undamped modes; take --speed 0, which gives damped modes at rest");
  if (session.model.rotation != nullptr)
    log::info("modes at rest; --speed OMEGA and --campbell FROM TO N give those of turning shafts");
  if (system.size() > 1 && system.dashpots.size() > 0)
    log::info(
        "the damping is that of each mode alone, phi^T C phi/(2 omega), but dashpots couple modes; --speed 0 gives "
        "damped modes");
  const auto closed = dynamics::closed_stops(session.model, arguments.closed);
  const bool writes = arguments.plot || !arguments.folder.empty();
  const record::ResultFolder folder(folder_of(arguments));
  if (writes) folder.check_holds_no_run();
  const Index count = arguments.count > 0 ? arguments.count : std::min(kDefaultCount, system.size());
  const modes::Analysis analysis = dynamics::analyse_modes(session.model, system, closed, count);
  if (arguments.json)
    print_json(modes::to_json(analysis));
  else
    modes::print(analysis);
  std::fflush(stdout);
  if (writes) write(analysis, session, system, arguments, folder);
  return kDone;
}

}  // namespace

Command add_modes_command(CLI::App& program) {
  const auto arguments = std::make_shared<ModesArguments>();
  CLI::App* app = program.add_subcommand("modes", "natural frequencies, damping, effective masses and mode shapes");
  add_model_arguments(*app, arguments->model);
  app->add_option("-n,--number", arguments->count, "the number of lowest modes; default 10")
      ->check(CLI::Range(1, 1000000))
      ->type_name("N");
  app->add_option("--closed", arguments->closed, "closed stops: all, or those on the nodes of a selector")
      ->type_name("SELECTOR|all")
      ->allow_extra_args(false);
  app->add_option("-o,--output", arguments->folder, "write frequencies.csv and shapes.csv into this folder")
      ->type_name("DIR");
  app->add_flag("--json", arguments->json, "print JSON");
  app->add_flag("--plot", arguments->plot, "draw the shapes by gnuplot; into <model>-modes without -o");
  app->add_option("--speed", arguments->speed,
                  "damped modes at this speed of rotation, rad/s; 0: at rest, in any scene")
      ->type_name("OMEGA");
  CLI::Option* const campbell =
      app->add_option("--campbell", arguments->campbell, "whirling modes at N + 1 speeds (rad/s), and critical speeds")
          ->expected(3)
          ->type_name("FROM TO N");
  app->add_option("--order", arguments->order, "order of critical speeds: oscillations per revolution; default 1")
      ->check(between(1e-3, 1e3))
      ->needs(campbell)
      ->type_name("X");
  add_log_options(*app, false);
  return {app, [arguments] { return modes_command(*arguments); }};
}

}  // namespace butee::app
