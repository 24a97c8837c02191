#pragma once

#include <functional>
#include <string>
#include <vector>

#include <butee/plugin/catalogue.hpp>

namespace butee::conformance {

/// A type under test: what scenes write to get it.
struct Subject {
  plugin::Catalogue catalogue;  ///< that knows it, and the standard types beside it
  std::string kind;             ///< "integrator", "law", "contact", "load" or "element"
  std::string name;
  std::string keys;  ///< TOML lines with its parameters
};

/// What a check came to.
struct Finding {
  bool passed;
  std::string details;  ///< figures, or what is wrong
};

/// One demand on every type of a kind.
struct Check {
  std::string name;
  std::string demand;  ///< a sentence for the report
  std::function<Finding(const Subject&)> run;
};

/// All checks of a kind, in the order in which they are worth reading.
std::vector<Check> checks_of(const std::string& kind);

std::vector<Check> integrator_checks();
std::vector<Check> law_checks();
std::vector<Check> contact_checks();
std::vector<Check> load_checks();
std::vector<Check> element_checks();

/// TOML lines for the parameters of a type: `given` ("beta=0.3"), else what the declaration says to try first, else its
/// default. Throws InputError for an unknown name, and for a required parameter that nothing is known of.
std::string keys_for(const std::vector<config::Parameter>& declared, const std::vector<std::string>& given);

}  // namespace butee::conformance
