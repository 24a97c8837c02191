#include <cstdio>

#include <butee/core/error.hpp>
#include <butee/core/log.hpp>
#include <butee/core/text.hpp>
#include <butee/plugin/catalogue.hpp>

#include "commands.hpp"
#include "plot/draw.hpp"
#include "study/pictures.hpp"

namespace butee::app {
namespace {

struct PlotArguments {
  plot::Request request;
  std::vector<std::string> plugins;
};

/// Draws a study from the rows that exist so far.
int plot_study(const PlotArguments& arguments) {
  const plot::Request& request = arguments.request;
  const std::string& folder = request.folders.front();
  if (request.folders.size() > 1) throw InputError(folder + ": is a study; draw each study in a separate call");
  if (!request.kinds.empty() || !request.probes.empty() || request.window.from > plot::Window{}.from ||
      request.window.to < plot::Window{}.to)
    throw InputError(folder + ": is a study, for which --kind, --probe, --from and --to do not apply");
  plot::require_gnuplot(request.formats);
  for (const std::string& file : studies::draw_folder(folder, request.output, request.formats))
    if (!log::is_quiet()) std::printf("%s\n", file.c_str());
  return kDone;
}

int plot_command(const PlotArguments& arguments) {
  for (const std::string& folder : arguments.request.folders)
    if (!study::Store::study_in(folder).empty()) return plot_study(arguments);
  const plot::Window window = arguments.request.window;
  if (!(window.from < window.to)) throw InputError("--from must be less than --to");
  for (const std::string& file : plot::draw(arguments.request, plugin::Catalogue::with_plugins(arguments.plugins)))
    if (!log::is_quiet()) std::printf("%s\n", file.c_str());
  return kDone;
}

}  // namespace

Command add_plot_command(CLI::App& program) {
  const auto arguments = std::make_shared<PlotArguments>();
  plot::Request& request = arguments->request;
  CLI::App* app =
      program.add_subcommand("plot", "draw the results of runs, several of them into one picture, or those of a study");
  app->add_option("folder", request.folders, "result folders of `butee run`, or one of `butee study`")
      ->required()
      ->type_name("DIR");
  app->add_option("--kind", request.kinds,
                  "kinds of pictures, or quantities of probes over time; default: all that the results allow")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("KIND,...:{" + join(plot::kind_names(), ",") + "}");
  app->add_option("--format", request.formats, "png (default), svg, pdf; script: for gnuplot elsewhere")
      ->delimiter(',')
      ->check(CLI::IsMember(plot::picture_formats()))
      ->allow_extra_args(false)
      ->type_name("FORMAT,...");
  app->add_option("--probe", request.probes, "the probes to draw; default: all")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("LABEL,...");
  app->add_option("--from", request.window.from, "the first instant drawn, s")->type_name("T");
  app->add_option("--to", request.window.to, "the last instant drawn, s")->type_name("T");
  app->add_option("-o,--output", request.output,
                  "the folder for the pictures; default DIR/plots, for several runs plots")
      ->type_name("DIR");
  add_plugin_option(*app, arguments->plugins);
  add_log_options(*app, false);
  return {app, [arguments] { return plot_command(*arguments); }};
}

}  // namespace butee::app
