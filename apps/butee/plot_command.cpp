#include <cstdio>

#include <butee/core/error.hpp>
#include <butee/core/log.hpp>
#include <butee/plugin/catalogue.hpp>

#include "commands.hpp"
#include "plot/draw.hpp"

namespace butee::app {
namespace {

struct PlotArguments {
  plot::Request request;
  std::vector<std::string> plugins;
};

int plot_command(const PlotArguments& arguments) {
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
  CLI::App* app = program.add_subcommand("plot", "draw the results of runs; several of them into one picture");
  app->add_option("folder", request.folders, "result folders of `butee run`")->required()->type_name("DIR");
  app->add_option("--kind", request.kinds, "what to draw; what the results allow where not given")
      ->delimiter(',')
      ->check(CLI::IsMember(plot::kind_names()))
      ->allow_extra_args(false)
      ->type_name("KIND,...");
  app->add_option("--format", request.formats, "png (default), svg, pdf; script: for gnuplot elsewhere")
      ->delimiter(',')
      ->check(CLI::IsMember(plot::picture_formats()))
      ->allow_extra_args(false)
      ->type_name("FORMAT,...");
  app->add_option("--probe", request.probes, "the probes to draw; all where not given")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("LABEL,...");
  app->add_option("--from", request.window.from, "draw from this instant on, s")->type_name("T");
  app->add_option("--to", request.window.to, "and up to this one, s")->type_name("T");
  app->add_option("-o,--output", request.output, "the folder for the pictures; DIR/plots, of several runs plots")
      ->type_name("DIR");
  add_plugin_option(*app, arguments->plugins);
  add_log_options(*app, false);
  return {app, [arguments] { return plot_command(*arguments); }};
}

}  // namespace butee::app
