#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <butee/core/error.hpp>
#include <butee/core/log.hpp>

#include "apps/conformance/report.hpp"

/// The program butee-conformance, called by `butee test-plugin`.
int main(int argc, char** argv) {
  using namespace butee;
  conformance::Request request;
  CLI::App app("runs the conformance suite on the types of a module");
  app.add_option("module", request.module)->required();
  app.add_option("--set", request.given)->allow_extra_args(false);
  app.add_option("--only", request.only)->allow_extra_args(false);
  app.add_option("--time-limit", request.time_limit);
  app.add_flag("--json", request.as_json);
  CLI11_PARSE(app, argc, argv);
  try {
    log::set_level(log::Level::quiet);
    return conformance::test_module(request) ? 0 : 1;
  } catch (const InputError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "butee test-plugin: %s\n", error.what());
    return 1;
  }
}
