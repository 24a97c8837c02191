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

constexpr std::int64_t kManifestSchema = 1;
constexpr std::array<const char*, 7> kKinds = {"number", "integer", "boolean", "text", "numbers", "texts", "table"};

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
  if (parameter.length) table["length"] = Value(static_cast<std::int64_t>(*parameter.length));
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
  if (table.find("length") != nullptr) parameter.length = static_cast<std::size_t>(get<std::int64_t>(table, "length"));
  return parameter;
}

}  // namespace

std::string manifest_path(const std::string& module) {
  return std::filesystem::path(module).replace_extension(".toml").string();
}

std::string write_manifest(const std::vector<time::IntegratorType>& integrators) {
  Table root;
  root["manifest"] = Value(kManifestSchema);
  Array list;
  for (const time::IntegratorType& type : integrators) {
    Table table;
    table["name"] = Value(type.name);
    table["aliases"] = text_array(type.aliases);
    table["summary"] = Value(type.summary);
    table["stability_limit"] = Value(type.stability_limit);
    table["finds_first_step"] = Value(type.finds_first_step);
    Array parameters;
    for (const Parameter& parameter : type.parameters) parameters.push_back(to_value(parameter));
    table["parameter"] = Value(std::move(parameters));
    list.emplace_back(std::move(table));
  }
  root["integrator"] = Value(std::move(list));
  return "# Made from the module beside it when that was built.\n" + config::write_toml(root);
}

Manifest read_manifest(const std::string& path) {
  const config::Document document = config::load_toml(path);
  try {
    const Table& root = *document.root.table();
    if (get<std::int64_t>(root, "manifest") != kManifestSchema) throw InputError("is of another schema");
    Manifest manifest;
    for (const Value& item : get<Array>(root, "integrator")) {
      if (item.table() == nullptr) throw InputError("has a wrong integrator");
      time::IntegratorType type;
      type.name = get<std::string>(*item.table(), "name");
      type.aliases = texts(*item.table(), "aliases");
      type.summary = get<std::string>(*item.table(), "summary");
      type.stability_limit = get<double>(*item.table(), "stability_limit");
      type.finds_first_step = get<bool>(*item.table(), "finds_first_step");
      for (const Value& parameter : get<Array>(*item.table(), "parameter"))
        if (parameter.table() != nullptr) type.parameters.push_back(to_parameter(*parameter.table()));
      manifest.integrators.push_back(std::move(type));
    }
    return manifest;
  } catch (const std::exception& error) {
    throw InputError(path + ": is no manifest of a butee module: " + error.what());
  }
}

}  // namespace butee::plugin
