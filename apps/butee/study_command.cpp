#include <charconv>
#include <cstdio>

#include <butee/core/error.hpp>
#include <butee/core/log.hpp>
#include <butee/core/terminal.hpp>
#include <butee/core/text.hpp>
#include <butee/study/perform.hpp>

#include "commands.hpp"
#include "interruption.hpp"
#include "study/progress_line.hpp"

namespace butee::app {
namespace {

struct StudyArguments {
  ModelArguments model;  ///< the study
  std::string folder;    ///< empty: "<stem>-study"
  std::string format;    ///< of the rows; empty: hdf5 where it is there
  std::string shard;     ///< "I/N"
  std::string progress = "auto";
  int threads = 0;
  bool fresh = false, merge = false;
};

study::Shard shard_of(const std::string& text) {
  if (text.empty()) return {};
  study::Shard shard;
  std::int64_t number = 0;
  const char* const end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, number);
  const bool has_slash = first.ec == std::errc() && first.ptr != end && *first.ptr == '/';
  const auto second = has_slash ? std::from_chars(first.ptr + 1, end, shard.count) : first;
  if (!has_slash || second.ec != std::errc() || second.ptr != end || number < 1 || number > shard.count)
    throw InputError("--shard " + text + ": write I/N, such as 2/8 for the second of eight parts");
  shard.index = number - 1;
  return shard;
}

int finish(study::Store& store, const StudyArguments& arguments) {
  const study::Store::Count count = store.count();
  const std::int64_t all = count.completed + count.failed;
  if (count.failed > 0)
    log::warning(std::to_string(count.failed) + " of " + std::to_string(all) +
                 " runs have no results; the rows say why, the first: " + count.first_reason);
  if (!log::is_quiet()) std::printf("%lld runs, rows in %s\n", static_cast<long long>(all), store.result().c_str());
  (void)arguments;
  return count.completed > 0 ? kDone : kFailed;
}

int study_command(const StudyArguments& arguments) {
  const study::Shard shard = shard_of(arguments.shard);
  const study::Study study =
      study::load_study(arguments.model.model, {arguments.model.overrides, arguments.model.plugins, {}});
  study::check_first_point(study);
  const study::Layout layout = layout_of(study);
  const auto format = study::row_format(arguments.format);
  std::string folder = arguments.folder.empty() ? study.stem + "-study" : arguments.folder;
  if (shard.count > 1) folder += "/shard-" + std::to_string(shard.index + 1) + "-of-" + std::to_string(shard.count);
  study::Store store(folder, study, layout, *format);
  store.open(arguments.fresh);
  watch_for_interruption();
  bool is_over = true;
  if (!store.is_complete() && !arguments.merge && store.done_count() < study.plan.run_count()) {
    if (store.done_count() > 0 && !log::is_quiet())
      log::info("going on: " + std::to_string(store.done_count()) + " runs are there already");
    store.begin(store.next_session(), 0);
    ProgressLine line(arguments.progress == "always" ||
                      (arguments.progress == "auto" && is_terminal(stderr) && !log::is_quiet()));
    study::PerformOptions options{arguments.threads, shard};
    options.goes_on = [] { return interruption() == nullptr; };
    options.report = [&](const study::Progress& progress) { line.report(progress); };
    is_over = study::perform(study, layout, store, options);
  }
  if (!is_over) {
    log::error(std::string("interrupted by ") + interruption() + "; the rows that are done are in " + folder +
               ", and the same command goes on from there");
    return kFailed;
  }
  if (shard.count > 1) {
    if (!log::is_quiet()) std::printf("shard %s is done, rows in %s\n", arguments.shard.c_str(), folder.c_str());
    return kDone;
  }
  std::int64_t missing = 0;
  if (!store.merge(missing))
    throw RunError(folder + ": run " + std::to_string(missing) +
                   " is missing, and perhaps more: a shard is not done yet; do it, or "
                   "`butee study` without --merge does what is left");
  return finish(store, arguments);
}

}  // namespace

Command add_study_command(CLI::App& program) {
  const auto arguments = std::make_shared<StudyArguments>();
  CLI::App* app = program.add_subcommand("study", "many runs of a scene whose keys vary: sweeps, maps, samples");
  app->add_option("study", arguments->model.model, "the study (TOML): scene, [[vary]], [study]")
      ->required()
      ->type_name("STUDY.toml");
  app->add_option("--set", arguments->model.overrides, "override a key of the scene in all runs")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  add_plugin_option(*app, arguments->model.plugins);
  app->add_option("-o,--output", arguments->folder, "the folder for the rows; <stem>-study where not given")
      ->type_name("DIR");
  app->add_option("-j,--threads", arguments->threads, "threads; as many as there are processors where not given")
      ->check(CLI::Range(1, 4096))
      ->type_name("N");
  app->add_option("--format", arguments->format, "of the rows: hdf5 (default where it is installed) or csv")
      ->check(CLI::IsMember({"hdf5", "csv"}));
  auto* fresh = app->add_flag("--fresh", arguments->fresh, "do again what an earlier call left in the folder");
  auto* shard =
      app->add_option("--shard", arguments->shard, "do one of N parts, as of a job array; --merge puts them together")
          ->type_name("I/N");
  app->add_flag("--merge", arguments->merge, "do nothing but put the rows of all shards together")
      ->excludes(shard)
      ->excludes(fresh);
  app->add_option("--progress", arguments->progress, "a line of progress on a terminal; always: in a log too")
      ->check(CLI::IsMember({"auto", "always", "never"}));
  add_log_options(*app, false);
  return {app, [arguments] { return study_command(*arguments); }};
}

}  // namespace butee::app
