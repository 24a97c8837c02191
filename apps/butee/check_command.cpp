#include <algorithm>
#include <ctime>
#include <fstream>

#include <butee/core/error.hpp>
#include <butee/core/log.hpp>
#include <butee/core/terminal.hpp>
#include <butee/dynamics/modal_dashpots.hpp>
#include <butee/dynamics/mode_analysis.hpp>
#include <butee/scene/assembly.hpp>

#include "check/picture.hpp"
#include "check/report.hpp"
#include "commands.hpp"
#include "study/survey.hpp"

namespace butee::app {
namespace {

struct CheckArguments {
  ModelArguments model;
  std::string picture;  ///< an SVG file; empty: no picture
  bool json = false;
};

/// The law of each [[contact]], as named in the file.
std::vector<std::string> laws_of(const config::Document& document) {
  std::vector<std::string> laws;
  const config::Value* contacts = document.root.table()->find("contact");
  if (contacts == nullptr || contacts->array() == nullptr) return laws;
  for (const config::Value& contact : *contacts->array()) {
    const config::Value* law = contact.table() != nullptr ? contact.table()->find("law") : nullptr;
    laws.push_back(law != nullptr && law->text() != nullptr ? *law->text() : "linear");
  }
  return laws;
}

void write_picture(const model::Model& model, const check::Survey& survey, const check::Layout& layout,
                   const std::string& path) {
  std::ofstream file(path, std::ios::binary);
  file << (check::is_in_space(model) ? check::picture_in_space(model, survey) : check::picture_svg(layout));
  file.close();
  if (!file) throw RunError(path + ": cannot be written");
}

/// The lowest frequencies are those of `butee modes`: the solvers of frequency_range() leave the rounding of the
/// highest ones in them.
void find_frequencies(const model::Model& model, const model::System& system, check::Facts& facts) {
  facts.open = frequency_range(system, dynamics::StopState::open);
  const bool has_stops = !system.stops.empty() || !system.obstacles.empty();
  facts.closed = has_stops ? frequency_range(system, dynamics::StopState::closed) : facts.open;
  if (!system.stiffness_is_symmetric) return;
  const auto refine = [&](std::optional<dynamics::FrequencyRange>& range, std::vector<dynamics::ClosedStop> closed) {
    try {
      const auto modes = dynamics::find_modes({model, system.dofs, std::move(closed)}, 1);
      if (range && modes.problem.empty()) range->lowest = modes.frequencies[0];
    } catch (const dynamics::UnstableStiffness&) {  // The advice names the growth.
    }
  };
  refine(facts.open, {});
  if (has_stops && system.obstacles.empty()) refine(facts.closed, dynamics::closed_stops(model, {"all"}));
  if (!has_stops) facts.closed = facts.open;
}

void find_critical_steps(scene::Scene& session, const model::System& system, check::Facts& facts) {
  dynamics::Dynamics dynamics(system);
  const auto steps = [&](const std::string& method) -> std::optional<time::CriticalSteps> {
    const plugin::IntegratorEntry* entry = session.catalogue.find(method);
    if (entry == nullptr) return std::nullopt;
    const time::IntegratorType& type = entry->declaration;
    return time::critical_steps(dynamics, {type.name, type.stability_limit, type.damping_limit}, facts.open,
                                facts.closed);
  };
  facts.of_runge_kutta = steps("rk4");
  facts.of_central_differences = steps("central_differences");
  time::MethodLimits limits = session.integrator.options.limits;
  if (session.catalogue.find(session.integrator.name)->declaration.fixed_step) {
    try {
      // The limit of some methods depends on their parameters.
      limits.stability = std::min(limits.stability, make_integrator(session, dynamics)->traits().stability_limit);
    } catch (const InputError&) {  // The trial reports the refusal.
    }
  }
  facts.of_method = time::critical_steps(dynamics, limits, facts.open, facts.closed);
}

int check_command(const CheckArguments& arguments) {
  if (studies::names_study(arguments.model.model)) {
    if (!arguments.picture.empty())
      throw InputError("--picture: draws a scene; " + arguments.model.model +
                       " is a study, which `butee study --plot` draws");
    studies::print_study_survey(arguments.model, arguments.json);
    return kDone;
  }
  if (!arguments.picture.empty() && std::filesystem::path(arguments.picture).extension() != ".svg")
    throw InputError("--picture " + arguments.picture + ": the picture is SVG; give a name that ends with .svg");
  scene::Scene session = open_session(arguments.model);
  const double reading_seconds = static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
  const model::System system = dynamics::assemble_to_run(session.model);
  check::Facts facts;
  facts.survey = check::survey_of(session.model);
  find_frequencies(session.model, system, facts);
  find_critical_steps(session, system, facts);
  facts.mechanics = check::mechanics_of(system, session.integrator.options.end_time);
  facts.instability = check::fastest_growth(session.model, system, session.integrator.options.end_time);
  facts.cost = check::estimate(session, reading_seconds);
  const auto advice = check::advise(session, system, facts);

  const check::Layout layout = check::layout_of(session.model, facts.survey, laws_of(session.document));
  if (arguments.json)
    print_json(check::to_json(session, system, facts, advice));
  else
    check::print(session, system, facts,
                 check::is_in_space(session.model)
                     ? check::list_in_space(session.model)
                     : check::picture_text(layout, terminal_width(stdout), check::locale_is_utf8()));
  std::fflush(stdout);
  if (!arguments.picture.empty()) write_picture(session.model, facts.survey, layout, arguments.picture);
  if (!arguments.json)
    for (const check::Advice& item : advice) log::warning(item.text);
  for (const std::string& warning : session.warnings) log::warning(warning);
  if (!facts.cost.refusal.empty()) throw InputError("a run of this scene is refused: " + facts.cost.refusal);
  return kDone;
}

}  // namespace

Command add_check_command(CLI::App& program) {
  const auto arguments = std::make_shared<CheckArguments>();
  CLI::App* app = program.add_subcommand(
      "check", "contents of a model and skipped parts: picture, frequencies, likely mistakes, cost of a run");
  add_model_arguments(*app, arguments->model);
  app->add_option("--picture", arguments->picture, "draw the scene as SVG into this file")->type_name("FILE.svg");
  app->add_flag("--json", arguments->json, "print JSON");
  return {app, [arguments] { return check_command(*arguments); }};
}

}  // namespace butee::app
