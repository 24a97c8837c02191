#pragma once

#include <string>

#include "session.hpp"

namespace butee::app {

/// Exit statuses of the program.
enum Exit : int { kDone = 0, kFailed = 1, kBadInput = 2 };

struct RunArguments {
  ModelArguments model;
  std::string folder;  ///< empty: "<model stem>-results"
  int repeat = 1;
  bool trust = false;  ///< as [output] trust
  std::string progress = "auto";
};

int run_command(const RunArguments& arguments);

int check_command(const ModelArguments& arguments);

struct PluginsArguments {
  std::string name;
  std::string write_manifest;  ///< a module whose manifest is wanted beside it
  std::vector<std::string> plugins;
};

int plugins_command(const PluginsArguments& arguments);

struct CompareArguments {
  ModelArguments model;  ///< a model or a study
  std::string folder;    ///< empty: "<stem>-compare"
  bool fresh = false;    ///< runs everything anew
};

int compare_command(const CompareArguments& arguments);

}  // namespace butee::app
