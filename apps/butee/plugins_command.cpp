#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>

#include <butee/config/toml.hpp>
#include <butee/core/error.hpp>
#include <butee/core/text.hpp>
#include <butee/model/quantity.hpp>
#include <butee/plugin/catalogue.hpp>
#include <butee/plugin/module.hpp>

#include "commands.hpp"
#include "json.hpp"
#include "parameter_table.hpp"

namespace butee::app {
namespace {

using config::Parameter;

struct Row {
  const char* kind;
  std::string name, aliases, summary;
  const std::vector<Parameter>* parameters;
  std::string module;
  std::string properties = {};
  std::vector<std::string> alias_list = {};
};

/// "order 4, fixed steps, bounded up to h omega = 2.83".
std::string properties_of(const time::IntegratorType& type) {
  std::vector<std::string> said;
  if (type.order > 0.0) said.push_back("order " + to_short_text(type.order));
  said.emplace_back(type.fixed_step ? "fixed steps" : "adaptive steps");
  if (std::isfinite(type.stability_limit))
    said.push_back("free motion is stable up to h omega = " + to_short_text(type.stability_limit));
  if (type.finds_first_step) said.emplace_back("time_step may be omitted");
  return join(said);
}

std::vector<Row> rows_of(const plugin::Catalogue& catalogue) {
  std::vector<Row> rows;
  for (const auto& entry : catalogue.integrators()) {
    const auto& type = entry.declaration;
    rows.push_back({"integrator", type.name, join(type.aliases), type.summary, &type.parameters, entry.module,
                    properties_of(type), type.aliases});
  }
  const model::ModelTypes& types = catalogue.types();
  const auto add = [&](const char* kind, const auto& list) {
    for (const auto& type : list)
      rows.push_back({kind, type.name, "", type.summary, &type.parameters, catalogue.module_of(kind, type.name), {}});
  };
  add("element", types.elements);
  add("section", types.sections);
  add("law", types.laws);
  add("contact", types.contacts);
  add("load", types.loads);
  add("format", types.formats);
  static const std::vector<Parameter> none;
  for (const std::string& name : model::probe_quantities()) {
    const model::Quantity quantity = model::quantity_of(name);
    const std::string unit = model::unit_of(quantity);
    rows.push_back({"quantity", name, "", std::string(model::summary_of(quantity)) + " (" + unit + ")", &none, "", {}});
  }
  return rows;
}

void print_list(const std::vector<Row>& rows) {
  const char* kind = "";
  for (const Row& row : rows) {
    if (std::string_view(kind) != row.kind)
      std::printf(
          "%s%s\n", *kind != '\0' ? "\n" : "",
          row.kind == std::string_view("quantity") ? "quantities of probes" : (row.kind + std::string("s")).c_str());
    kind = row.kind;
    std::printf("  %-26s %-6s %s\n", row.name.c_str(), row.aliases.c_str(), row.summary.c_str());
  }
}

void print_details(const Row& row) {
  std::printf("%s %s%s\n  %s\n", row.kind, row.name.c_str(),
              row.aliases.empty() ? "" : (" (alias " + row.aliases + ")").c_str(), row.summary.c_str());
  if (!row.properties.empty()) std::printf("  %s\n", row.properties.c_str());
  if (!row.module.empty()) std::printf("  module %s\n", row.module.c_str());
  if (!row.parameters->empty()) std::printf("\n%s", parameter_table(*row.parameters).c_str());
}

Json json_of(const Parameter& parameter) {
  Json json;
  json["name"] = parameter.name;
  json["unit"] = parameter.unit;
  json["required"] = parameter.required;
  json["default"] = parameter.fallback ? Json(config::to_toml(*parameter.fallback)) : Json();
  json["allowed"] = parameter.describe();
  json["help"] = parameter.help;
  if (!parameter.choices.empty()) json["choices"] = parameter.choices;
  return json;
}

Json json_of(const Row& row) {
  Json json;
  json["kind"] = row.kind;
  json["name"] = row.name;
  json["aliases"] = row.alias_list;
  json["summary"] = row.summary;
  json["module"] = row.module.empty() ? Json() : Json(row.module);
  json["parameters"] = Json::array();
  for (const Parameter& parameter : *row.parameters) json["parameters"].push_back(json_of(parameter));
  return json;
}

bool answers_to(const Row& row, const std::string& name) {
  return row.name == name || row.aliases == name ||
         (", " + row.aliases + ",").find(", " + name + ",") != std::string::npos;
}

void write_manifest(const std::string& module) {
  const std::string path = plugin::manifest_path(module);
  const std::string manifest = plugin::write_manifest(plugin::load_module(module).types());
  std::ofstream file(path, std::ios::binary);
  file << manifest;
  file.close();
  if (!file) throw RunError(path + ": cannot be written");
}

struct PluginsArguments {
  std::string name;
  std::string write_manifest;  ///< a module whose manifest is written beside it
  std::vector<std::string> plugins;
  bool json = false;
};

int plugins_command(const PluginsArguments& arguments) {
  if (!arguments.write_manifest.empty()) {
    write_manifest(arguments.write_manifest);
    return kDone;
  }
  const auto catalogue = plugin::Catalogue::with_plugins(arguments.plugins);
  const auto rows = rows_of(catalogue);
  std::vector<const Row*> wanted;
  std::vector<std::string> known;
  for (const Row& row : rows) {
    known.push_back(row.name);
    if (arguments.name.empty() || answers_to(row, arguments.name)) wanted.push_back(&row);
  }
  if (wanted.empty())
    throw InputError("there is no \"" + arguments.name + "\"" + suggestion(arguments.name, known) +
                     "; `butee plugins` lists all; for stop, friction, distributed loads and damping see `butee help "
                     "contact`, `butee help loads` and `butee help damping`");
  if (arguments.json) {
    Json list = Json::array();
    for (const Row* row : wanted) list.push_back(json_of(*row));
    print_json(list);
  } else if (arguments.name.empty()) {
    print_list(rows);
  } else {
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      if (i > 0) std::printf("\n");
      print_details(*wanted[i]);
    }
  }
  return kDone;
}

}  // namespace

Command add_plugins_command(CLI::App& program) {
  const auto arguments = std::make_shared<PluginsArguments>();
  CLI::App* app = program.add_subcommand(
      "plugins", "list the names that a scene may use: methods, elements, laws, contacts, loads, formats");
  app->add_option("name", arguments->name, "show the parameters of this one")->type_name("NAME");
  add_plugin_option(*app, arguments->plugins);
  app->add_flag("--json", arguments->json, "print JSON");
  app->add_option("--write-manifest", arguments->write_manifest, "write the manifest of a module beside it")
      ->type_name("FILE");
  return {app, [arguments] { return plugins_command(*arguments); }};
}

}  // namespace butee::app
