#include <filesystem>

#include <butee/config/file_reference.hpp>
#include <butee/config/toml.hpp>
#include <butee/core/error.hpp>
#include <butee/core/log.hpp>

#include "commands.hpp"
#include "modes/report.hpp"

namespace butee::app {
namespace {

constexpr Index kDefaultCount = 10;

struct ModesArguments {
  ModelArguments model;
  Index count = 0;  ///< 0: kDefaultCount, or all of a smaller scene
  std::vector<std::string> closed;
  std::string folder;  ///< empty: nothing is written, unless a plot is wanted
  bool json = false, plot = false;
};

void write(const modes::Analysis& analysis, const Session& session, const model::System& system,
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
  const Session session = open_session(arguments.model);
  const model::System system = assemble(session.model);
  const auto closed = modes::closed_stops(session.model, arguments.closed);
  const bool writes = arguments.plot || !arguments.folder.empty();
  const record::ResultFolder folder(!arguments.folder.empty()
                                        ? arguments.folder
                                        : std::filesystem::path(arguments.model.model).stem().string() + "-modes");
  if (writes) folder.check();
  if (writes && std::filesystem::exists(folder.file("history.csv")))
    throw InputError(folder.path() + ": holds the results of a run; choose another folder with -o");
  const Index count = arguments.count > 0 ? arguments.count : std::min(kDefaultCount, system.size());
  const modes::Analysis analysis = modes::analyse(session.model, system, closed, count);
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
  app->add_option("-n,--number", arguments->count, "so many of the lowest modes; 10 where not given")
      ->check(CLI::Range(1, 1000000))
      ->type_name("N");
  app->add_option("--closed", arguments->closed, "stops that hold: all, or those on the nodes of a selector")
      ->type_name("SELECTOR|all")
      ->allow_extra_args(false);
  app->add_option("-o,--output", arguments->folder, "write frequencies.csv and shapes.csv into this folder")
      ->type_name("DIR");
  app->add_flag("--json", arguments->json, "print JSON");
  app->add_flag("--plot", arguments->plot, "draw the shapes by gnuplot; into <model>-modes where -o is not given");
  add_log_options(*app, false);
  return {app, [arguments] { return modes_command(*arguments); }};
}

}  // namespace butee::app
