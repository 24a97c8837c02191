#pragma once

#include <string>
#include <vector>

#include <butee/plugin/catalogue.hpp>

namespace butee::app::help {

/// A topic of `butee help`. Types of modules and of the framework are printed from their declarations.
struct Topic {
  std::string name, summary;
  std::string (*text)(const plugin::Catalogue& catalogue);
};

const std::vector<Topic>& topics();

// Topics on scenes, in scene_topics.cpp.
std::string model_text(const plugin::Catalogue& catalogue);
std::string selectors_text(const plugin::Catalogue& catalogue);
std::string elements_text(const plugin::Catalogue& catalogue);
std::string space_text(const plugin::Catalogue& catalogue);
std::string contact_text(const plugin::Catalogue& catalogue);
std::string loads_text(const plugin::Catalogue& catalogue);
std::string damping_text(const plugin::Catalogue& catalogue);
std::string integrators_text(const plugin::Catalogue& catalogue);
std::string output_text(const plugin::Catalogue& catalogue);

// Topics on the program, in program_topics.cpp.
std::string methods_text(const plugin::Catalogue& catalogue);
std::string results_text(const plugin::Catalogue& catalogue);
std::string limits_text(const plugin::Catalogue& catalogue);
std::string compare_text(const plugin::Catalogue& catalogue);
std::string study_text(const plugin::Catalogue& catalogue);  // in study_topic.cpp
std::string trust_text(const plugin::Catalogue& catalogue);
std::string plugins_text(const plugin::Catalogue& catalogue);
std::string exit_codes_text(const plugin::Catalogue& catalogue);
std::string environment_text(const plugin::Catalogue& catalogue);

}  // namespace butee::app::help
