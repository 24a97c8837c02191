#pragma once

#include <functional>
#include <string>
#include <vector>

#include <butee/plugin/catalogue.hpp>

namespace butee::conformance {

/// A type under test and its text in a scene.
struct Subject {
  plugin::Catalogue catalogue;  ///< contains the subject and the standard types
  std::string kind;             ///< "integrator", "law", "contact", "load" or "element"
  std::string name;
  std::string keys;  ///< TOML lines with its parameters
};

/// The result of a check.
struct Finding {
  bool passed;
  std::string details;  ///< figures, or the reason of the failure
};

/// One requirement on all types of a kind.
struct Check {
  std::string name;
  std::string demand;  ///< a sentence for the report
  std::function<Finding(const Subject&)> run;
};

/// All checks of a kind, in the order of the report.
std::vector<Check> checks_of(const std::string& kind);

std::vector<Check> integrator_checks();
std::vector<Check> law_checks();
std::vector<Check> contact_checks();
std::vector<Check> load_checks();
std::vector<Check> element_checks();

/// TOML lines for the parameters of a type: `given` ("beta=0.3"), otherwise the recommended first value,
/// otherwise the default. Throws InputError for an unknown name, and for a required parameter without any of
/// these values.
std::string keys_for(const std::vector<config::Parameter>& declared, const std::vector<std::string>& given);

}  // namespace butee::conformance
