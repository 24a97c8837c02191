#include "butee/plugin/integrator_choice.hpp"

#include <algorithm>
#include <map>

#include "butee/core/text.hpp"

namespace butee::plugin {
namespace {

using config::Diagnostics;
using config::number;
using config::Parameter;
using config::Table;
using config::Value;

std::vector<Parameter> common_parameters() {
  return {number("time_step", "s", "the step, of an adaptive method the first").above(0),
          number("end_time", "s", "the end of the run, which starts at t = 0").above(0)};
}

std::vector<Parameter> parameters_of(const IntegratorEntry& entry) {
  std::vector<Parameter> all = common_parameters();
  const auto& own = entry.declaration.parameters;
  all.insert(all.end(), own.begin(), own.end());
  return all;
}

/// The methods that have a parameter of this name.
std::vector<std::string> owners_of(const std::string& key, const Catalogue& catalogue) {
  std::vector<std::string> owners;
  for (const auto& entry : catalogue.integrators())
    if (const auto names = names_of(entry.declaration.parameters);
        std::find(names.begin(), names.end(), key) != names.end())
      owners.push_back(entry.declaration.name);
  return owners;
}

class ChoiceReader {
 public:
  ChoiceReader(const Table& table, config::Location at, const Catalogue& catalogue, Diagnostics& diagnostics)
      : table_(table), at_(at), catalogue_(catalogue), diagnostics_(diagnostics) {}

  std::optional<IntegratorChoice> read() {
    const std::size_t errors_before = diagnostics_.error_count();
    const IntegratorEntry* chosen = chosen_entry();
    read_method_tables();
    check_direct_keys(chosen);
    if (chosen == nullptr) return std::nullopt;

    Table merged;
    if (const auto found = method_tables_.find(chosen); found != method_tables_.end()) merged = *found->second->table();
    for (const auto& [key, value] : table_.entries)
      if (key != "type" && value.table() == nullptr) merged[key] = value;
    if (diagnostics_.error_count() > errors_before) {
      report_missing(merged);
      return std::nullopt;
    }
    auto parameters =
        read_parameters(Value(std::move(merged), at_), "integrator", parameters_of(*chosen), diagnostics_);
    if (!parameters) return std::nullopt;
    const double time_step = parameters->number("time_step"), end_time = parameters->number("end_time");
    if (time_step > end_time) {
      parameters->complain(diagnostics_, "time_step", "must not be larger than end_time = " + to_text(end_time) + " s");
      return std::nullopt;
    }
    return IntegratorChoice{chosen->declaration.name, {time_step, end_time}, std::move(*parameters)};
  }

 private:
  const IntegratorEntry* chosen_entry() {
    const Value* type = table_.find("type");
    const auto known = catalogue_.integrator_names();
    const std::string choices = "known: " + join(known);
    if (type == nullptr) {
      diagnostics_.error("integrator.type", at_, "missing; give the name of a method; " + choices);
      return nullptr;
    }
    const std::string* name = type->text();
    const IntegratorEntry* entry = name != nullptr ? catalogue_.find(*name) : nullptr;
    if (entry == nullptr)
      diagnostics_.error(
          "integrator.type", *type,
          "there is no such integrator" + (name != nullptr ? suggestion(*name, known) : "") + "; " + choices);
    return entry;
  }

  /// [integrator.NAME]: each is checked, chosen or not; required keys may stand in [integrator] instead.
  void read_method_tables() {
    for (const auto& [key, value] : table_.entries) {
      if (value.table() == nullptr) continue;
      const std::string path = "integrator." + key;
      const IntegratorEntry* entry = catalogue_.find(key);
      if (entry == nullptr) {
        const auto known = catalogue_.integrator_names();
        diagnostics_.error(path, value.at,
                           "there is no integrator of this name" + suggestion(key, known) + "; known: " + join(known));
        continue;
      }
      if (!method_tables_.emplace(entry, &value).second)
        diagnostics_.error(path, value.at,
                           "is a second table for " + entry->declaration.name + ", whose names are " + join([&] {
                             auto names = entry->declaration.aliases;
                             names.insert(names.begin(), entry->declaration.name);
                             return names;
                           }()) +
                               "; keep one of the two");
      std::vector<Parameter> declared = parameters_of(*entry);
      for (Parameter& parameter : declared) parameter = parameter.optional();
      read_parameters(value, path, declared, diagnostics_);
    }
  }

  void check_direct_keys(const IntegratorEntry* chosen) {
    const auto known = names_of(chosen != nullptr ? parameters_of(*chosen) : common_parameters());
    for (const auto& [key, value] : table_.entries) {
      if (key == "type" || value.table() != nullptr || std::find(known.begin(), known.end(), key) != known.end())
        continue;
      const auto owners = owners_of(key, catalogue_);
      if (chosen == nullptr && !owners.empty()) continue;
      std::string complaint = "unknown key" + suggestion(key, known);
      if (!owners.empty())
        complaint = "is no parameter of " + chosen->declaration.name + "; it belongs to " + join(owners) +
                    ": move it to a table [integrator." + owners.front() + "]";
      diagnostics_.error("integrator." + key, value, complaint + "; known here: " + join(known));
    }
  }

  /// After other mistakes the merged table is not read as a whole, but what every method needs is still asked for.
  void report_missing(const Table& merged) {
    for (const Parameter& parameter : common_parameters())
      if (merged.find(parameter.name) == nullptr)
        diagnostics_.error("integrator." + parameter.name, at_, "missing; give " + parameter.help);
  }

  const Table& table_;
  config::Location at_;
  const Catalogue& catalogue_;
  Diagnostics& diagnostics_;
  std::map<const IntegratorEntry*, const Value*> method_tables_;
};

}  // namespace

std::optional<IntegratorChoice> read_integrator(const Value& root, const Catalogue& catalogue,
                                                Diagnostics& diagnostics) {
  const Value* integrator = root.table()->find("integrator");
  if (integrator == nullptr) {
    diagnostics.error("integrator", root.at,
                      "missing; a scene says how it is integrated: [integrator] with type, time_step and end_time");
    return std::nullopt;
  }
  if (integrator->table() == nullptr) {
    diagnostics.error("integrator", *integrator, std::string("must be a table, not ") + integrator->kind());
    return std::nullopt;
  }
  return ChoiceReader(*integrator->table(), integrator->at, catalogue, diagnostics).read();
}

}  // namespace butee::plugin
