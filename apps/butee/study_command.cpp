#include <algorithm>
#include <cstdio>
#include <filesystem>

#include <butee/config/toml.hpp>
#include <butee/core/error.hpp>
#include <butee/core/log.hpp>
#include <butee/core/terminal.hpp>
#include <butee/core/text.hpp>
#include <butee/study/perform.hpp>
#include <butee/study/store.hpp>
#include <butee/study/team.hpp>

#include "commands.hpp"
#include "gnuplot.hpp"
#include "interruption.hpp"
#include "plot/draw.hpp"
#include "study/horizon.hpp"
#include "study/pictures.hpp"
#include "study/progress_line.hpp"
#include "study/streamed_points.hpp"

namespace butee::app {
namespace {

struct StudyArguments {
  ModelArguments model;  ///< the study
  std::string folder;    ///< empty: "<stem>-study"
  std::string format;    ///< format of the rows; empty: hdf5 if available
  std::string shard;     ///< "I/N"
  std::string points;    ///< a CSV file, or "-" for standard input
  std::string results;
  std::string progress = "auto";
  std::vector<std::string> plot_formats = {"png"};
  int threads = 0;
  bool fresh = false, merge = false, plot = false;
};

study::Shard shard_of(const std::string& text) {
  if (text.empty()) return {};
  const auto slash = text.find('/');
  const auto number = whole_number<std::int64_t>(std::string_view(text).substr(0, slash));
  const auto count =
      slash == std::string::npos ? std::nullopt : whole_number<std::int64_t>(std::string_view(text).substr(slash + 1));
  if (!number || !count || *number < 1 || *number > *count)
    throw InputError("--shard " + text + ": write I/N, such as 2/8 for the second of eight parts");
  study::Shard shard;
  shard.index = *number - 1;
  shard.count = *count;
  return shard;
}

/// Runs one study into its folder, by this process or by the processes of a team.
class FolderStudy {
 public:
  FolderStudy(const StudyArguments& arguments, study::Team* team)
      : arguments_(arguments),
        team_(team),
        shard_(shard_of(arguments.shard)),
        study_(study::load_study(arguments.model.model,
                                 {arguments.model.overrides, arguments.model.plugins, {}, studies::horizon_of})),
        layout_(layout_of(study_)),
        format_(study::row_format(arguments.format)),
        store_(folder(), study_, layout_, *format_) {
    if (team != nullptr && !arguments.shard.empty()) throw InputError("--shard: mpirun already distributes the runs");
    study::check_points(study_);
    if (shard_.count > 1) study::Store::refuse_foreign(main_folder());
    if (arguments.plot) plot::require_gnuplot(arguments.plot_formats);
  }

  bool is_first() const { return team_ == nullptr || team_->rank() == 0; }
  void open() {
    if (arguments_.merge && !std::filesystem::exists(store_.folder()))
      throw InputError("--merge: there is nothing to merge: " + store_.folder() + " does not exist");
    store_.open(arguments_.fresh);
  }
  void look() { store_.look(); }

  /// Performs the remaining runs.
  int perform() {
    if (store_.is_complete() || arguments_.merge || store_.done_count() == study_.plan.run_count()) return kDone;
    if (store_.done_count() > 0 && is_first() && !log::is_quiet())
      log::info("continuing: " + std::to_string(store_.done_count()) + " runs are done already");
    store_.begin(store_.next_session(), team_ != nullptr ? team_->rank() : 0);
    studies::ProgressLine line(is_first() &&
                               (arguments_.progress == "always" ||
                                (arguments_.progress == "auto" && is_terminal(stderr) && !log::is_quiet())));
    study::PerformOptions options{arguments_.threads, shard_};
    std::optional<study::Dealer> dealer;
    if (team_ != nullptr) {
      if (options.threads == 0) options.threads = 1;
      options.dealer = &dealer.emplace(*team_, study_.plan.chain_count(), options.threads);
      options.serve = [this] { team_->serve(); };
    }
    options.goes_on = [] { return interruption() == nullptr; };
    options.report = [&](const study::Progress& progress) { line.report(progress); };
    if (study::perform(study_, layout_, store_, options)) return kDone;
    if (is_first())
      log::error(std::string("interrupted by ") + interruption() + "; the finished rows are in " + store_.folder() +
                 "; the same command continues from there");
    return kFailed;
  }

  int finish() {
    if (shard_.count > 1) {
      store_.flush();
      if (!log::is_quiet())
        std::printf("shard %s is done, rows in %s\n", arguments_.shard.c_str(), store_.folder().c_str());
      return kDone;
    }
    std::int64_t missing = 0;
    if (!store_.merge(missing))
      throw RunError(store_.folder() + ": run " + std::to_string(missing) +
                     " is missing, and perhaps more: not all shards are done. Without --merge, `butee study` performs "
                     "the remaining runs");
    const study::Store::Count count = store_.count();
    const std::int64_t all = count.completed + count.failed;
    if (count.failed > 0)
      log::warning(std::to_string(count.failed) + " of " + std::to_string(all) +
                   " runs have no results; the rows give the reasons, the first: " + count.first_reason);
    if (!log::is_quiet()) std::printf("%lld runs, rows in %s\n", static_cast<long long>(all), store_.result().c_str());
    if (arguments_.plot)
      for (const std::string& file : studies::draw_study(study_, layout_, store_, arguments_.plot_formats))
        if (!log::is_quiet()) std::printf("  picture %s\n", file.c_str());
    return count.completed > 0 ? kDone : kFailed;
  }

 private:
  std::string main_folder() const { return arguments_.folder.empty() ? study_.stem + "-study" : arguments_.folder; }
  std::string folder() const {
    std::string folder = main_folder();
    if (shard_.count > 1)
      folder += "/shard-" + std::to_string(shard_.index + 1) + "-of-" + std::to_string(shard_.count);
    return folder;
  }

  const StudyArguments& arguments_;
  study::Team* team_;
  study::Shard shard_;
  study::Study study_;
  study::Layout layout_;
  std::unique_ptr<study::RowFormat> format_;
  study::Store store_;
};

int study_alone(const StudyArguments& arguments) {
  FolderStudy study(arguments, nullptr);
  study.open();
  watch_for_interruption();
  const int status = study.perform();
  return status == kDone ? study.finish() : status;
}

/// Every process reads the study; the first process opens the folder. All continue only if no process failed.
int study_in_team(const StudyArguments& arguments, study::Team& team) {
  if (team.rank() > 0) log::set_level(log::Level::quiet);
  std::optional<FolderStudy> study;
  int status = kDone;
  // The first process reports an error that all share; other processes report only their own errors.
  const auto step = [&](bool takes_part, auto work) {
    if (status == kDone && takes_part) {
      try {
        status = work();
      } catch (const InputError& error) {
        status = kBadInput;
        log::error(error.what());
      } catch (const std::exception& error) {
        status = kFailed;
        log::error(error.what());
      }
    }
    status = team.agree(status);
  };
  const bool is_first = team.rank() == 0;
  const auto load = [&] {
    study.emplace(arguments, &team);
    return static_cast<int>(kDone);
  };
  step(is_first, load);
  step(!is_first, load);
  step(is_first, [&] {
    study->open();
    return static_cast<int>(kDone);
  });
  step(!is_first, [&] {
    study->look();
    return static_cast<int>(kDone);
  });
  watch_for_interruption();
  step(true, [&] { return study->perform(); });
  step(is_first, [&] { return study->finish(); });
  return status;
}

int study_command(const StudyArguments& arguments) {
  if (arguments.points.empty() != arguments.results.empty())
    throw InputError("--points and --results go together: points from a file or -, rows into a file or -");
  if (!arguments.points.empty())
    return studies::answer_points({arguments.model, arguments.points, arguments.results, arguments.threads});
  const auto team = study::join_team();
  return team != nullptr ? study_in_team(arguments, *team) : study_alone(arguments);
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
  auto* output = app->add_option("-o,--output", arguments->folder, "the folder for the rows; default <stem>-study")
                     ->type_name("DIR");
  app->add_option("-j,--threads", arguments->threads, "the number of threads; default: the number of processors")
      ->check(CLI::Range(1, 4096))
      ->type_name("N");
  auto* format =
      app->add_option("--format", arguments->format, "format of the rows: hdf5 (default if installed) or csv")
          ->check(CLI::IsMember({"hdf5", "csv"}));
  auto* fresh =
      app->add_flag("--fresh", arguments->fresh, "run everything again, without the results of an earlier call");
  auto* shard =
      app->add_option("--shard", arguments->shard, "perform one of N parts, for a job array")->type_name("I/N");
  auto* merge = app->add_flag("--merge", arguments->merge, "join the rows of all shards without further runs")
                    ->excludes(shard)
                    ->excludes(fresh);
  auto* points = app->add_option("--points", arguments->points, "points from a CSV file or -, instead of [[vary]]")
                     ->type_name("FILE|-")
                     ->excludes(shard)
                     ->excludes(merge)
                     ->excludes(fresh)
                     ->excludes(output)
                     ->excludes(format);
  app->add_option("--results", arguments->results, "with --points, rows as CSV into a file or to -, in their order")
      ->type_name("FILE|-");
  app->add_flag("--plot", arguments->plot, "draw what the rows allow: bifurcation, response, map, histogram")
      ->excludes(points);
  app->add_option("--plot-format", arguments->plot_formats, "format of pictures: png (default), svg, pdf")
      ->delimiter(',')
      ->check(CLI::IsMember(gnuplot::formats()))
      ->allow_extra_args(false)
      ->type_name("FORMAT,...");
  app->add_option("--progress", arguments->progress, "a line of progress on a terminal; always: in a log too")
      ->check(CLI::IsMember({"auto", "always", "never"}));
  add_log_options(*app, false);
  return {app, [arguments] { return study_command(*arguments); }};
}

}  // namespace butee::app
