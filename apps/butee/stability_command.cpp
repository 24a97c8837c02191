#include <algorithm>
#include <cstdio>

#include <butee/core/error.hpp>
#include <butee/core/log.hpp>
#include <butee/core/text.hpp>
#include <butee/record/result_folder.hpp>

#include "commands.hpp"
#include "stability/report.hpp"

namespace butee::app {
namespace {

using namespace stability;

struct StabilityArguments {
  std::string method;  ///< empty: all methods
  std::string folder;  ///< empty: "<method>-stability", or "stability" for all methods
  Request request{{}, {0.0, 0.05, 0.5}, {0.01, 0.1, 1.0, 10.0, 100.0, 1e3, 1e4}};
  bool json = false;
  std::vector<std::string> plugins;
};

std::vector<std::string> methods_of(const plugin::Catalogue& catalogue, const std::string& wanted) {
  std::vector<std::string> methods;
  if (wanted.empty()) {
    for (const auto& entry : catalogue.integrators()) methods.push_back(entry.declaration.name);
    return methods;
  }
  const plugin::IntegratorEntry* entry = catalogue.find(wanted);
  const auto known = catalogue.integrator_names();
  if (entry == nullptr)
    throw InputError("there is no integrator \"" + wanted + "\"" + suggestion(wanted, known) +
                     "; known: " + join(known));
  return {entry->declaration.name};
}

int stability_command(const StabilityArguments& arguments) {
  if (arguments.method.empty() && !arguments.request.settings.empty())
    throw InputError("--set requires a METHOD: parameters belong to one method");
  for (const std::string& setting : arguments.request.settings)
    for (const char* determined : {"time_step", "end_time"})
      if (setting.starts_with(std::string(determined) + "="))
        throw InputError("--set " + setting + ": stability is found at every step; remove it");
  const auto catalogue = plugin::Catalogue::with_plugins(arguments.plugins);
  const auto methods = methods_of(catalogue, arguments.method);
  const record::ResultFolder folder(!arguments.folder.empty()
                                        ? arguments.folder
                                        : (arguments.method.empty() ? "stability" : methods.front() + "-stability"));
  folder.check_holds_no_run();
  std::vector<Analysis> all;
  for (const std::string& method : methods) all.push_back(analyse(catalogue, method, arguments.request));
  const record::FolderLock lock = folder.lock();
  folder.prepare("# the stability of " + join(methods) + ", by butee stability\n");
  folder.write("stability.csv", curves_csv(all));
  folder.write("stops.csv", stops_csv(all));
  folder.write("stability.json", to_json(all, arguments.request));
  if (!draw(all, arguments.request, folder.path()))
    log::warning("gnuplot could not draw; its scripts are in " + folder.path() + " (Debian: gnuplot-nox)");
  if (arguments.json)
    std::fputs(to_json(all, arguments.request).c_str(), stdout);
  else
    std::printf("%scurves and pictures in %s\n", table(all, arguments.request).c_str(), folder.path().c_str());
  return kDone;
}

}  // namespace

Command add_stability_command(CLI::App& program) {
  const auto arguments = std::make_shared<StabilityArguments>();
  CLI::App* app =
      program.add_subcommand("stability", "stability limit, numerical damping and period error of a method");
  app->add_option("method", arguments->method, "an integrator; default: all")->type_name("METHOD");
  app->add_option("--set", arguments->request.settings, "a parameter of the method: rho_inf=0.5")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  app->add_option("--damping", arguments->request.ratios, "damping ratios, separated by commas; default 0, 0.05, 0.5")
      ->delimiter(',')
      ->check(between(0.0, 1e6))
      ->type_name("RATIO");
  app->add_option("--stops", arguments->request.stop_ratios,
                  "stiffnesses k_c/k of a closed stop, separated by commas; default 0.01, 0.1 ... 1e4")
      ->delimiter(',')
      ->check(between(1e-12, 1e12))
      ->type_name("RATIO");
  app->add_option("-o,--output", arguments->folder, "the folder for the results; default <method>-stability")
      ->type_name("DIR");
  app->add_flag("--json", arguments->json, "print JSON");
  add_plugin_option(*app, arguments->plugins);
  add_log_options(*app, false);
  return {app, [arguments] { return stability_command(*arguments); }};
}

}  // namespace butee::app
