#include "butee/plugin/manifest.hpp"

#include <algorithm>
#include <array>
#include <filesystem>

#include "butee/config/toml.hpp"
#include "butee/core/error.hpp"

namespace butee::plugin {
namespace {

using config::Array;
using config::Parameter;
using config::Table;
using config::Value;

constexpr std::int64_t kManifestSchema = 7;
constexpr std::array<const char*, 8> kKinds = {"number",  "integer", "boolean", "text",
                                               "numbers", "texts",   "table",   "matrix"};

Value text_array(const std::vector<std::string>& texts) {
  Array array;
  for (const std::string& text : texts) array.emplace_back(text);
  return {array};
}

Value to_value(const Parameter& parameter) {
  Table table;
  table["name"] = Value(parameter.name);
  table["kind"] = Value(std::string(kKinds.at(static_cast<std::size_t>(parameter.kind))));
  table["unit"] = Value(parameter.unit);
  table["help"] = Value(parameter.help);
  table["required"] = Value(parameter.required);
  if (parameter.fallback) table["default"] = *parameter.fallback;
  table["lower"] = Value(parameter.lower);
  table["lower_open"] = Value(parameter.lower_open);
  table["upper"] = Value(parameter.upper);
  if (!parameter.choices.empty()) table["choices"] = text_array(parameter.choices);
  if (parameter.first_try) table["first_try"] = *parameter.first_try;
  if (parameter.swept) table["sweep"] = Value(Array{Value(parameter.swept->first), Value(parameter.swept->second)});
  if (parameter.length) table["length"] = Value(static_cast<std::int64_t>(*parameter.length));
  if (parameter.columns) table["columns"] = Value(static_cast<std::int64_t>(*parameter.columns));
  return {table};
}

const Value& at(const Table& table, const char* key) {
  const Value* value = table.find(key);
  if (value == nullptr) throw InputError(std::string("has no key ") + key);
  return *value;
}

template <class Kind>
const Kind& get(const Table& table, const char* key) {
  const Kind* value = std::get_if<Kind>(&at(table, key).data);
  if (value == nullptr) throw InputError(std::string("has a wrong ") + key);
  return *value;
}

std::vector<std::string> texts(const Table& table, const char* key) {
  std::vector<std::string> list;
  for (const Value& item : get<Array>(table, key)) list.push_back(std::get<std::string>(item.data));
  return list;
}

Parameter to_parameter(const Table& table) {
  Parameter parameter;
  parameter.name = get<std::string>(table, "name");
  const std::string& kind = get<std::string>(table, "kind");
  const auto* const found = std::find(kKinds.begin(), kKinds.end(), kind);
  if (found == kKinds.end()) throw InputError("has an unknown kind " + kind);
  parameter.kind = static_cast<Parameter::Kind>(found - kKinds.begin());
  parameter.unit = get<std::string>(table, "unit");
  parameter.help = get<std::string>(table, "help");
  parameter.required = get<bool>(table, "required");
  if (const Value* fallback = table.find("default")) parameter.fallback = *fallback;
  parameter.lower = get<double>(table, "lower");
  parameter.lower_open = get<bool>(table, "lower_open");
  parameter.upper = get<double>(table, "upper");
  if (table.find("choices") != nullptr) parameter.choices = texts(table, "choices");
  if (const Value* first_try = table.find("first_try")) parameter.first_try = *first_try;
  if (table.find("sweep") != nullptr) {
    const Array& ends = get<Array>(table, "sweep");
    if (ends.size() != 2) throw InputError("has a wrong sweep");
    parameter.swept = std::pair(std::get<double>(ends[0].data), std::get<double>(ends[1].data));
  }
  if (table.find("length") != nullptr) parameter.length = static_cast<std::size_t>(get<std::int64_t>(table, "length"));
  if (table.find("columns") != nullptr)
    parameter.columns = static_cast<std::size_t>(get<std::int64_t>(table, "columns"));
  return parameter;
}

/// The properties common to all types: name, summary and parameters.
template <class Type>
Table common_part(const Type& type) {
  Table table;
  table["name"] = Value(type.name);
  table["summary"] = Value(type.summary);
  Array parameters;
  for (const Parameter& parameter : type.parameters) parameters.push_back(to_value(parameter));
  table["parameter"] = Value(std::move(parameters));
  return table;
}

template <class Type>
Type read_common_part(const Table& table) {
  Type type;
  type.name = get<std::string>(table, "name");
  type.summary = get<std::string>(table, "summary");
  for (const Value& parameter : get<Array>(table, "parameter"))
    if (parameter.table() != nullptr) type.parameters.push_back(to_parameter(*parameter.table()));
  return type;
}

template <class Type>
void write_types(const std::vector<Type>& types, const char* key, Table& root) {
  Array list;
  for (const Type& type : types) list.emplace_back(common_part(type));
  if (!list.empty()) root[key] = Value(std::move(list));
}

template <class Type>
void read_types(const Table& root, const char* key, std::vector<Type>& types) {
  if (root.find(key) == nullptr) return;
  for (const Value& item : get<Array>(root, key)) {
    if (item.table() == nullptr) throw InputError(std::string("has a wrong ") + key);
    types.push_back(read_common_part<Type>(*item.table()));
  }
}

}  // namespace

std::string manifest_path(const std::string& module) {
  return std::filesystem::path(module).replace_extension(".toml").string();
}

std::string write_manifest(const ModuleTypes& types) {
  Table root;
  root["manifest"] = Value(kManifestSchema);
  Array list;
  for (const time::IntegratorType& type : types.integrators) {
    Table table = common_part(type);
    table["aliases"] = text_array(type.aliases);
    table["stability_limit"] = Value(type.stability_limit);
    table["order"] = Value(type.order);
    table["fixed_step"] = Value(type.fixed_step);
    table["damping_limit"] = Value(type.damping_limit);
    table["finds_first_step"] = Value(type.finds_first_step);
    list.emplace_back(std::move(table));
  }
  if (!list.empty()) root["integrator"] = Value(std::move(list));
  write_types(types.laws, "law", root);
  write_types(types.contacts, "contact", root);
  write_types(types.loads, "load", root);
  write_types(types.elements, "element", root);
  write_types(types.formats, "format", root);
  return "# Generated from the module of the same name when it was built.\n" + config::write_toml(root);
}

ModuleTypes read_manifest(const std::string& path) {
  const config::Document document = config::load_toml(path);
  try {
    const Table& root = *document.root.table();
    if (get<std::int64_t>(root, "manifest") != kManifestSchema) throw InputError("has another schema");
    ModuleTypes types;
    read_types(root, "integrator", types.integrators);
    for (std::size_t i = 0; i < types.integrators.size(); ++i) {
      const Table& table = *get<Array>(root, "integrator")[i].table();
      types.integrators[i].aliases = texts(table, "aliases");
      types.integrators[i].stability_limit = get<double>(table, "stability_limit");
      types.integrators[i].order = get<double>(table, "order");
      types.integrators[i].fixed_step = get<bool>(table, "fixed_step");
      types.integrators[i].damping_limit = get<double>(table, "damping_limit");
      types.integrators[i].finds_first_step = get<bool>(table, "finds_first_step");
    }
    read_types(root, "law", types.laws);
    read_types(root, "contact", types.contacts);
    read_types(root, "load", types.loads);
    read_types(root, "element", types.elements);
    read_types(root, "format", types.formats);
    if (types.integrators.empty() && types.laws.empty() && types.contacts.empty() && types.loads.empty() &&
        types.elements.empty() && types.formats.empty())
      throw InputError("names no type");
    return types;
  } catch (const std::exception& error) {
    throw InputError(path + ": is not a manifest of a butee module: " + error.what());
  }
}

}  // namespace butee::plugin
