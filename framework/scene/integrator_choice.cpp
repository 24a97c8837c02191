#include "butee/scene/integrator_choice.hpp"

#include <algorithm>
#include <map>

#include "butee/core/text.hpp"

namespace butee::scene {
namespace {

using config::Diagnostics;
using config::number;
using config::Parameter;
using config::Table;
using config::Value;

/// The default method of a scene.
constexpr const char* kDefault = "auto";

std::vector<Parameter> common_parameters() {
  return {number("time_step", "s", "the step, or the first step of an adaptive method").above(0),
          number("end_time", "s", "the end of the run, which starts at t = 0").above(0)};
}

time::MethodLimits limits_of(const time::IntegratorType& type) {
  return {type.name, type.stability_limit, type.damping_limit, type.finds_first_step};
}

/// The methods that have a parameter of this name.
std::vector<std::string> owners_of(const std::string& key, const plugin::Catalogue& catalogue) {
  std::vector<std::string> owners;
  for (const auto& entry : catalogue.integrators())
    if (const auto names = names_of(entry.declaration.parameters);
        std::find(names.begin(), names.end(), key) != names.end())
      owners.push_back(entry.declaration.name);
  return owners;
}

class ChoiceReader {
 public:
  ChoiceReader(const Table& table, config::Location at, const plugin::Catalogue& catalogue, Diagnostics& diagnostics)
      : table_(table), at_(at), catalogue_(catalogue), diagnostics_(diagnostics) {}

  std::optional<IntegratorChoice> read() {
    const std::size_t errors_before = diagnostics_.error_count();
    const plugin::IntegratorEntry* chosen = chosen_entry();
    read_method_tables();
    check_direct_keys(chosen);
    auto parameters = read_merged(chosen);
    if (chosen == nullptr || diagnostics_.error_count() > errors_before) return std::nullopt;
    const double end_time = parameters->number("end_time");
    if (!parameters->has("time_step"))
      return IntegratorChoice{
          chosen->declaration.name, {0.0, end_time, limits_of(chosen->declaration)}, std::move(*parameters)};
    const double time_step = parameters->number("time_step");
    if (time_step > end_time) {
      parameters->complain(diagnostics_, "time_step", "must not be larger than end_time = " + to_text(end_time) + " s");
      return std::nullopt;
    }
    if (end_time + time_step == end_time) {
      parameters->complain(diagnostics_, "time_step",
                           "is lost in rounding relative to end_time = " + to_text(end_time) + " s; make it larger");
      return std::nullopt;
    }
    return IntegratorChoice{
        chosen->declaration.name, {time_step, end_time, limits_of(chosen->declaration)}, std::move(*parameters)};
  }

 private:
  const plugin::IntegratorEntry* chosen_entry() {
    const Value* type = table_.find("type");
    const auto known = catalogue_.integrator_names();
    const std::string choices = "known: " + join(known);
    if (type == nullptr) {
      const plugin::IntegratorEntry* automatic = catalogue_.find(kDefault);
      if (automatic == nullptr)
        diagnostics_.error("integrator.type", at_, "missing; give the name of a method; " + choices);
      return automatic;
    }
    const std::string* name = type->text();
    const plugin::IntegratorEntry* entry = name != nullptr ? catalogue_.find(*name) : nullptr;
    if (entry == nullptr)
      diagnostics_.error("integrator.type", *type,
                         (name != nullptr ? "there is no such integrator" + suggestion(*name, known)
                                          : std::string("must be a string, not ") + type->kind()) +
                             "; " + choices);
    return entry;
  }

  /// A table belongs to a method, unless its key is the name of a parameter, whose value may be
  /// wrong.
  bool is_method_table(const Table::Entry& entry) const {
    const auto common = names_of(common_parameters());
    return entry.second.table() != nullptr && entry.first != "type" &&
           std::find(common.begin(), common.end(), entry.first) == common.end() &&
           owners_of(entry.first, catalogue_).empty();
  }

  /// [integrator.NAME]: each is checked, chosen or not; required keys may be in [integrator]
  /// instead.
  void read_method_tables() {
    for (const Table::Entry& item : table_.entries) {
      if (!is_method_table(item)) continue;
      const auto& [key, value] = item;
      const std::string path = "integrator." + key;
      const plugin::IntegratorEntry* entry = catalogue_.find(key);
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

  void check_direct_keys(const plugin::IntegratorEntry* chosen) {
    const auto known = names_of(chosen != nullptr ? parameters_of(*chosen) : common_parameters());
    for (const Table::Entry& item : table_.entries) {
      const auto& [key, value] = item;
      if (key == "type" || is_method_table(item) || std::find(known.begin(), known.end(), key) != known.end()) continue;
      const auto owners = owners_of(key, catalogue_);
      if (chosen == nullptr && !owners.empty()) continue;
      std::string complaint = "unknown key" + suggestion(key, known);
      if (!owners.empty())
        complaint = "is no parameter of " + chosen->declaration.name + "; it belongs to " + join(owners) +
                    ": remove it, or move it to a table [integrator." + owners.front() +
                    "], which counts where that method is chosen";
      diagnostics_.error("integrator." + key, value, complaint + "; known here: " + join(known));
      meant_.push_back(closest_name(key, known));
    }
  }

  /// The chosen method's parameters, or those that all methods have: direct keys take precedence
  /// over its table's, whose errors were reported already.
  std::optional<config::Parameters> read_merged(const plugin::IntegratorEntry* chosen) {
    const auto found = method_tables_.find(chosen);
    const Table* own = found != method_tables_.end() ? found->second->table() : nullptr;
    std::vector<Parameter> declared;
    Table merged;
    for (const Parameter& parameter : chosen != nullptr ? parameters_of(*chosen) : common_parameters()) {
      const Value* value = table_.find(parameter.name);
      if (value == nullptr && own != nullptr) {
        value = own->find(parameter.name);
        if (value != nullptr && !parameter.complaint(*value).empty()) continue;
      }
      if (value != nullptr) merged[parameter.name] = *value;
      // Whether a step is needed depends on the method; a key that is meant by a wrong one counts as a single mistake.
      const bool may_lack = (chosen == nullptr && parameter.name == "time_step") ||
                            std::find(meant_.begin(), meant_.end(), parameter.name) != meant_.end();
      declared.push_back(may_lack ? Parameter(parameter).optional() : parameter);
    }
    auto read = read_parameters(Value(std::move(merged), at_), "integrator", declared, diagnostics_);
    return meant_.empty() ? read : std::nullopt;
  }

  const Table& table_;
  config::Location at_;
  const plugin::Catalogue& catalogue_;
  Diagnostics& diagnostics_;
  std::map<const plugin::IntegratorEntry*, const Value*> method_tables_;
  std::vector<std::string> meant_;  ///< keys closest to unknown ones
};

/// Overrides are the sources after the file.
bool is_override(const Value& value) {
  return value.at.source > 0;
}

}  // namespace

std::vector<config::Parameter> parameters_of(const plugin::IntegratorEntry& entry) {
  std::vector<Parameter> all = common_parameters();
  if (entry.declaration.finds_first_step) all.front() = all.front().optional();
  const auto& own = entry.declaration.parameters;
  all.insert(all.end(), own.begin(), own.end());
  return all;
}

std::string set_aside_keys(config::Document& document, const plugin::Catalogue& catalogue) {
  Table* root = document.root.table();
  Value* integrator = root != nullptr ? root->find("integrator") : nullptr;
  Table* table = integrator != nullptr ? integrator->table() : nullptr;
  const Value* type = table != nullptr ? table->find("type") : nullptr;
  if (type == nullptr || !is_override(*type) || type->text() == nullptr) return "";
  const plugin::IntegratorEntry* chosen = catalogue.find(*type->text());
  if (chosen == nullptr) return "";
  const auto own = names_of(parameters_of(*chosen));
  std::vector<std::string> aside;
  for (const auto& [key, value] : table->entries)
    if (!is_override(value) && std::find(own.begin(), own.end(), key) == own.end() &&
        !owners_of(key, catalogue).empty())
      aside.push_back(key);
  if (aside.empty()) return "";
  const bool is_one = aside.size() == 1;
  const std::string line = describe(document, type->at) + ": the file's " + (is_one ? "key " : "keys ") + join(aside) +
                           (is_one ? " is" : " are") + " ignored, because " + chosen->declaration.name +
                           " does not have " + (is_one ? "it" : "them");
  std::erase_if(table->entries, [&](const Table::Entry& entry) {
    return std::find(aside.begin(), aside.end(), entry.first) != aside.end();
  });
  return line;
}

bool has_truncation(const std::string& method) {
  return method != "exact" && method != "piecewise";
}

std::optional<double> tolerance_of(const IntegratorChoice& choice, const std::string& method) {
  if (!choice.options.limits.keeps_tolerance || !has_truncation(method) || !choice.parameters.has("tolerance"))
    return std::nullopt;
  return choice.parameters.number("tolerance");
}

std::optional<IntegratorChoice> read_integrator(const Value& root, const plugin::Catalogue& catalogue,
                                                Diagnostics& diagnostics) {
  const Value* integrator = root.table()->find("integrator");
  if (integrator == nullptr) {
    diagnostics.error(
        "integrator", root.at,
        "missing; give [integrator] with end_time, and with type and tolerance if the defaults do not suit");
    return std::nullopt;
  }
  if (integrator->table() == nullptr) {
    diagnostics.error("integrator", *integrator, std::string("must be a table, not ") + integrator->kind());
    return std::nullopt;
  }
  return ChoiceReader(*integrator->table(), integrator->at, catalogue, diagnostics).read();
}

}  // namespace butee::scene
