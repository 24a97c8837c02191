#include "apps/conformance/check.hpp"

#include <algorithm>

#include <butee/config/toml.hpp>
#include <butee/core/error.hpp>
#include <butee/core/text.hpp>

namespace butee::conformance {

using config::Parameter;

namespace {

std::string value_text(const std::string& text) {
  return config::parse_toml_value(text) ? text : config::to_toml(config::Value(text));
}

}  // namespace

std::vector<Check> checks_of(const std::string& kind) {
  if (kind == "integrator") return integrator_checks();
  if (kind == "law") return law_checks();
  if (kind == "contact") return contact_checks();
  if (kind == "load") return load_checks();
  return element_checks();
}

std::string keys_for(const std::vector<Parameter>& declared, const std::vector<std::string>& given) {
  std::string lines;
  std::vector<std::string> named;
  for (const std::string& assignment : given) {
    const std::size_t sign = assignment.find('=');
    const std::string key = assignment.substr(0, sign);
    const auto names = config::names_of(declared);
    if (sign == std::string::npos || std::find(names.begin(), names.end(), key) == names.end())
      throw InputError("--set " + assignment + ": is not KEY=VALUE with a parameter of this type" +
                       suggestion(key, names) + "; it has: " + (names.empty() ? "none" : join(names)));
    named.push_back(key);
    lines += key + " = " + value_text(assignment.substr(sign + 1)) + "\n";
  }
  for (const Parameter& parameter : declared) {
    if (!parameter.required || std::find(named.begin(), named.end(), parameter.name) != named.end()) continue;
    if (!parameter.first_try)
      throw InputError(parameter.name +
                       ": is required and has neither a default nor a first value to try; give one by --set " +
                       parameter.name + "=VALUE");
    lines += parameter.name + " = " + config::to_toml(*parameter.first_try) + "\n";
  }
  return lines;
}

}  // namespace butee::conformance
