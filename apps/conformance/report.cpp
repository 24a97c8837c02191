#include "apps/conformance/report.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include <butee/core/error.hpp>
#include <butee/core/text.hpp>
#include <butee/plugin/module.hpp>
#include <nlohmann/json.hpp>

#include "apps/conformance/isolated.hpp"

namespace butee::conformance {
namespace {

using nlohmann::json;

struct Named {
  std::string kind, name;
  const std::vector<config::Parameter>* parameters;
};

/// The types that the module (or the modules of a folder) adds to a catalogue.
std::vector<Named> types_of(const plugin::Catalogue& catalogue, const std::string& place) {
  const std::string path = std::filesystem::weakly_canonical(place).string();
  const auto is_from_it = [&](const std::string& module) { return module == path || module.rfind(path + "/", 0) == 0; };
  std::vector<Named> found;
  for (const auto& entry : catalogue.integrators())
    if (is_from_it(entry.module))
      found.push_back({"integrator", entry.declaration.name, &entry.declaration.parameters});
  const auto add = [&](const char* kind, const auto& types) {
    for (const auto& type : types)
      if (is_from_it(catalogue.module_of(kind, type.name))) found.push_back({kind, type.name, &type.parameters});
  };
  add("law", catalogue.types().laws);
  add("contact", catalogue.types().contacts);
  add("load", catalogue.types().loads);
  add("element", catalogue.types().elements);
  return found;
}

/// The keys given by the user that this type has.
std::vector<std::string> keys_of_type(const std::vector<std::string>& given,
                                      const std::vector<config::Parameter>& declared) {
  std::vector<std::string> fitting;
  const auto names = config::names_of(declared);
  for (const std::string& assignment : given)
    if (std::find(names.begin(), names.end(), assignment.substr(0, assignment.find('='))) != names.end())
      fitting.push_back(assignment);
  return fitting;
}

/// Default nodes of the suite's scene for elements, unless the user gives nodes.
std::string element_places(const Named& type, const std::string& keys) {
  std::string lines = "name = \"subject\"\n";
  for (const config::Parameter& p : *type.parameters) {
    if (keys.rfind(p.name + " = ", 0) == 0 || keys.find("\n" + p.name + " = ") != std::string::npos || !p.required)
      continue;
    if (p.name == "node") lines += "node = \"string:2\"\n";
    if (p.name == "nodes") lines += "nodes = [\"string:1\", \"string:2\"]\n";
    if (p.name == "material") lines += "material = \"steel\"\n";
    if (p.name == "section") lines += "section = \"pipe\"\n";
  }
  return lines;
}

Subject subject_of(const plugin::Catalogue& catalogue, const Named& type, const std::vector<std::string>& given) {
  std::vector<config::Parameter> declared = *type.parameters;
  std::string places;
  if (type.kind == "element") {
    std::string named;
    for (const std::string& assignment : given) named += assignment.substr(0, assignment.find('=')) + " = \n";
    places = element_places(type, named);
    std::erase_if(declared,
                  [&](const config::Parameter& p) { return places.find("\n" + p.name + " = ") != std::string::npos; });
  }
  return {catalogue, type.kind, type.name, keys_for(declared, keys_of_type(given, declared)) + places};
}

bool has(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// The types to test. Throws InputError if the request names a type or a parameter that there is not.
std::vector<Named> requested(std::vector<Named> types, const Request& request) {
  std::vector<std::string> names;
  for (const Named& type : types) names.push_back(type.name);
  for (const std::string& name : request.only)
    if (!has(names, name))
      throw InputError("--only " + name + ": " + request.module + " has no type of this name" +
                       suggestion(name, names) + "; it has: " + (names.empty() ? "none" : join(names)));
  if (!request.only.empty()) std::erase_if(types, [&](const Named& type) { return !has(request.only, type.name); });
  std::vector<std::string> keys;
  for (const Named& type : types)
    for (const std::string& key : config::names_of(*type.parameters))
      if (!has(keys, key)) keys.push_back(key);
  for (const std::string& assignment : request.given)
    if (const std::string key = assignment.substr(0, assignment.find('=')); !has(keys, key))
      throw InputError("--set " + assignment + ": none of the types tested has a parameter " + key +
                       suggestion(key, keys) + "; they have: " + (keys.empty() ? "none" : join(keys)));
  return types;
}

void print(const Check& check, const Finding& finding) {
  std::printf("  %-4s  %-13s  %s\n", finding.passed ? "ok" : "FAIL", check.name.c_str(), finding.details.c_str());
  if (!finding.passed) std::printf("        %-13s  demanded: %s\n", "", check.demand.c_str());
  std::fflush(stdout);
}

}  // namespace

bool test_module(const Request& request) {
  plugin::Catalogue catalogue = plugin::Catalogue::with_plugins();
  // Load in a separate process first: a crash during loading is then a finding and does not end this program.
  const Finding loading = run_isolated(
      [&] {
        try {
          plugin::Catalogue other = catalogue;
          other.add(request.module);
          if (!std::filesystem::is_directory(request.module)) plugin::load_module(request.module);
          return Finding{true, ""};
        } catch (const std::exception& error) {
          return Finding{false, error.what()};
        }
      },
      request.time_limit);
  if (!loading.passed) throw InputError("loading " + request.module + ": " + loading.details);
  catalogue.add(request.module);

  std::size_t passed = 0, count = 0;
  json report = json::array();
  for (const Named& type : requested(types_of(catalogue, request.module), request)) {
    const Subject subject = subject_of(catalogue, type, request.given);
    if (!request.as_json) std::printf("%s %s\n", type.kind.c_str(), type.name.c_str());
    for (const Check& check : checks_of(type.kind)) {
      const Finding finding = run_isolated([&] { return check.run(subject); }, request.time_limit);
      ++count;
      passed += finding.passed ? 1 : 0;
      if (!request.as_json) print(check, finding);
      report.push_back({{"kind", type.kind},
                        {"type", type.name},
                        {"check", check.name},
                        {"passed", finding.passed},
                        {"details", finding.details}});
    }
  }
  if (count == 0) throw InputError(request.module + ": contains no type that can be tested");
  if (request.as_json)
    std::printf("%s\n", report.dump(2).c_str());
  else
    std::printf("%zu of %zu checks passed\n", passed, count);
  return passed == count;
}

}  // namespace butee::conformance
