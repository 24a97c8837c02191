#include <array>
#include <filesystem>
#include <set>
#include <sstream>

#include <butee/config/toml.hpp>
#include <butee/core/error.hpp>
#include <butee/plugin/catalogue.hpp>
#include <butee/plugin/module.hpp>
#include <gtest/gtest.h>

#include "support/program.hpp"
#include "support/scene_run.hpp"

namespace butee::test::modules_test {
namespace {

namespace fs = std::filesystem;

std::string broken(const std::string& name) {
  return std::string(BUTEE_TEST_BROKEN) + "/" + name + ".so";
}

std::string complaint(const std::string& module) {
  try {
    plugin::load_module(module);
  } catch (const RunError& error) {
    return error.what();
  }
  return "";
}

void expect_mentions(const std::string& text, const std::vector<std::string>& parts) {
  for (const std::string& part : parts)
    EXPECT_NE(text.find(part), std::string::npos) << "\"" << part << "\" in: " << text;
}

/// The shared objects in the plugin folder that the dynamic linker opened.
std::set<std::string> opened_modules(const std::string& linker_log) {
  std::set<std::string> modules;
  std::istringstream lines(linker_log);
  for (std::string line; std::getline(lines, line);) {
    const auto at = line.find(BUTEE_TEST_PLUGINS);
    if (at == std::string::npos) continue;
    const auto end = line.find(".so", at);
    if (end != std::string::npos) modules.insert(fs::path(line.substr(at, end + 3 - at)).stem().string());
  }
  return modules;
}

TEST(Modules, ARunLoadsTheOneItNamesAndNoOther) {
  const TemporaryFolder folder;
  const auto outcome = run_program({"run", model_path("oscillator"), "--set", "integrator.type=RK4-3", "--set",
                                    "integrator.end_time=1e-3", "--set", "output.interval=1e-4", "-q"},
                                   folder.path(), {"LD_DEBUG=files"});
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_EQ(opened_modules(outcome.errors), std::set<std::string>{"rk4_error_scaled"});
}

TEST(Modules, ListingAndDescribingLoadNone) {
  const TemporaryFolder folder;
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{"plugins"}, {"plugins", "NM2"}}) {
    const auto outcome = run_program(arguments, folder.path(), {"LD_DEBUG=files"});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_TRUE(opened_modules(outcome.errors).empty());
    EXPECT_NE(outcome.output.find("newmark_adaptive"), std::string::npos);
  }
}

TEST(Modules, ManifestsSayWhatTheModulesDeclare) {
  int compared = 0;
  for (const auto& file : fs::directory_iterator(BUTEE_TEST_PLUGINS)) {
    if (file.path().extension() != ".so") continue;
    const auto written = plugin::read_manifest(plugin::manifest_path(file.path().string()));
    const auto declared = plugin::load_module(file.path().string()).types();
    EXPECT_EQ(plugin::write_manifest(written), plugin::write_manifest(declared));
    if (file.path().stem() != "sundials" && file.path().stem() != "hdf5") ++compared;  // optional
  }
  EXPECT_EQ(compared, 21);
}

TEST(Modules, BrokenOnesAreRefusedWithTheReason) {
  expect_mentions(complaint(broken("no_door")), {"no_door.so", "not a butee module", "butee_plugin_abi"});
  expect_mentions(complaint(broken("other_interface")), {"other_interface.so", "built for another butee",
                                                         "interface version", "Eigen alignment", "16 instead of 64"});
  expect_mentions(complaint(broken("throwing")), {"throwing.so", "no licence for this machine"});
  const TemporaryFolder folder;
  folder.write("text.so", "this is no shared object");
  expect_mentions(complaint(folder.file("text.so")), {"text.so", "cannot be loaded"});
  expect_mentions(complaint(folder.file("absent.so")), {"absent.so", "cannot be loaded"});
}

TEST(Modules, AThrowingOneRegistersNothing) {
  plugin::Catalogue catalogue;
  EXPECT_THROW(catalogue.add(broken("throwing")), RunError);
  EXPECT_EQ(catalogue.find("half_registered"), nullptr);
}

TEST(Modules, ANameTakenTwiceIsRefusedWithBothFiles) {
  plugin::Catalogue catalogue;
  catalogue.add(BUTEE_TEST_PLUGINS);
  const std::size_t before = catalogue.integrators().size();
  try {
    catalogue.add(broken("duplicate"));
    FAIL() << "a second RK4-1 was taken";
  } catch (const RunError& error) {
    expect_mentions(error.what(), {"RK4-1", "rk4.so", "duplicate.so"});
  }
  EXPECT_EQ(catalogue.integrators().size(), before);
}

TEST(Modules, TypesAndParametersNeedNamesOfTheirOwn) {
  const auto complaint_about = [](const std::string& name, std::vector<config::Parameter> parameters) -> std::string {
    plugin::ModuleTypes types;
    types.laws.push_back({name, "", std::move(parameters), nullptr});
    try {
      plugin::Catalogue().add(std::move(types), "mine");
    } catch (const RunError& error) {
      return error.what();
    }
    return "";
  };
  const config::Parameter factor = config::number("factor", "", "a"), nameless = config::number("", "", "a");
  EXPECT_EQ(complaint_about("soft", {factor}), "");
  EXPECT_EQ(complaint_about("", {factor}), "mine: registers a type of law without a name");
  EXPECT_EQ(complaint_about("soft", {factor, factor}),
            "mine: the law \"soft\" declares the parameter \"factor\" twice");
  EXPECT_EQ(complaint_about("soft", {nameless}), "mine: the law \"soft\" declares a parameter without a name");
  expect_mentions(
      complaint_about("soft", {factor.above(0.0).or_else(0.0)}),
      {"\"soft\" declares a default of the parameter \"factor\" that it does not allow itself: must be > 0"});
  expect_mentions(complaint_about("soft", {factor.or_else(NAN)}), {"must be a finite number"});
  expect_mentions(complaint_about("soft", {factor.at_most(1.0).try_first(2.0)}), {"declares a value to try first"});
  expect_mentions(complaint_about("soft\n", {factor}), {"the law \"soft?\" uses the name \"soft?\"; names are of"});
  expect_mentions(complaint_about("soft", {config::number("a b", "", "a")}), {"uses the name \"a b\""});
}

TEST(Modules, LimitsAndOrdersAreNumbers) {
  const auto complaint_about = [](double stability, double damping, double order) -> std::string {
    time::IntegratorType method;
    method.name = "own";
    method.stability_limit = stability;
    method.damping_limit = damping;
    method.order = order;
    plugin::ModuleTypes types;
    types.integrators = {method};
    plugin::Catalogue catalogue;
    try {
      catalogue.add(std::move(types), "mine");
      return "";
    } catch (const RunError& error) {
      return error.what();
    }
  };
  EXPECT_EQ(complaint_about(2.0, INFINITY, 2.0), "");
  EXPECT_EQ(complaint_about(0.0, 2.0, 2.0),
            "mine: the integrator \"own\" declares stability_limit = 0.0; it must be > 0, or infinity");
  expect_mentions(complaint_about(2.0, NAN, 2.0), {"damping_limit = nan"});
  expect_mentions(complaint_about(2.0, 2.0, INFINITY), {"order = inf", "a number >= 0"});
}

TEST(Modules, NamesAndKeysThatSceneTablesHaveThemselvesAreRefused) {
  const auto complaint_about = [](const std::string& name, const std::string& key) -> std::string {
    plugin::ModuleTypes types;
    model::LoadType load;
    load.name = name;
    load.parameters = {config::number(key, "", "a")};
    types.loads = {load};
    plugin::Catalogue catalogue;
    try {
      catalogue.add(std::move(types), "mine");
      return "";
    } catch (const RunError& error) {
      return error.what();
    }
  };
  EXPECT_EQ(complaint_about("pulse", "width"), "");
  expect_mentions(complaint_about("distributed", "width"), {"\"distributed\" is registered twice: by butee itself"});
  EXPECT_EQ(complaint_about("pulse", "dof"),
            "mine: the load \"pulse\" declares the parameter \"dof\", a key that every [[load]] has; rename it");
}

/// A factory that lacks a node, because the element of the node has an error, reports nothing itself.
TEST(Modules, AnElementOnNodesOfAWrongElementIsNoFaultOfItsModule) {
  plugin::ModuleTypes types;
  model::ElementType tie;
  tie.name = "tie";
  tie.parameters = {config::text("node", "where it acts")};
  tie.nodes = [](const config::Parameters&, config::Diagnostics&) -> model::ElementType::Nodes { return std::nullopt; };
  tie.make = [](const config::Parameters& p, model::ElementContext& context) -> std::unique_ptr<model::Element> {
    EXPECT_FALSE(context.node(p, "node"));
    return nullptr;
  };
  types.elements = {tie};
  plugin::Catalogue catalogue;
  catalogue.add(std::move(types), "mine");
  try {
    (void)scene::read_scene(config::parse_toml("schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = "
                                               "-1.0\n[[element]]\ntype = \"tie\"\nnode = \"m\"\n"
                                               "[integrator]\nend_time = 1.0\n",
                                               "scene.toml"),
                            catalogue);
    FAIL() << "was read";
  } catch (const InputError& error) {
    expect_mentions(error.what(), {"scene.toml:5: element[0].mass = -1.0: must be >= 0"});
  }
}

/// Matrices that cannot be assembled are reported with the line of their element.
TEST(Modules, WrongMatricesAreReportedWithTheElement) {
  class Crooked final : public model::Element {
   public:
    explicit Crooked(model::NodeId node) : node_(node) {}
    void claim(model::DofTable& dofs) const override {
      for (const DofKind kind : {DofKind::uy, DofKind::rz}) dofs.claim({node_, kind}, true);
    }
    void assemble(model::MatrixSink& sink) const override {
      model::ElementMatrices matrices(2);
      matrices.mass << 1.0, 0.3, 0.2, 1.0;
      sink.add(std::array{model::NodalDof{node_, DofKind::uy}, model::NodalDof{node_, DofKind::rz}}, matrices);
    }

   private:
    model::NodeId node_;
  };
  plugin::ModuleTypes types;
  model::ElementType crooked;
  crooked.name = "crooked";
  crooked.parameters = {config::text("node", "where it acts")};
  crooked.nodes = [](const config::Parameters&, config::Diagnostics&) -> model::ElementType::Nodes {
    return std::nullopt;
  };
  crooked.make = [](const config::Parameters& p, model::ElementContext& context) -> std::unique_ptr<model::Element> {
    return std::make_unique<Crooked>(*context.node(p, "node"));
  };
  types.elements = {crooked};
  plugin::Catalogue catalogue;
  catalogue.add(std::move(types), "mine");
  try {
    (void)scene::read_scene(
        config::parse_toml("schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 1.0\n"
                           "[[element]]\ntype = \"crooked\"\nnode = \"m\"\n[integrator]\nend_time = 1.0\n",
                           "scene.toml"),
        catalogue);
    FAIL() << "was read";
  } catch (const InputError& error) {
    expect_mentions(error.what(), {"scene.toml:6: element[1]: its mass matrix is not symmetric"});
  }
}

TEST(Modules, AFolderOfModulesIsFoundByEnvironmentAndOption) {
  const TemporaryFolder folder;
  fs::create_directory(folder.file("more"));
  fs::copy_file(broken("duplicate"), folder.file("more/duplicate.so"));
  const auto without = run_program({"plugins", "mine"}, folder.path());
  EXPECT_EQ(without.status, 2);
  // A module in a folder without a manifest is ignored with a warning; a module named as a file is loaded,
  // and refused here.
  const auto by_folder = run_program({"plugins"}, folder.path(), {"BUTEE_PLUGIN_PATH=" + folder.file("more")});
  EXPECT_EQ(by_folder.status, 0);
  expect_mentions(by_folder.errors, {"duplicate.so", "no manifest"});
  const auto by_file = run_program({"plugins", "--plugin", folder.file("more/duplicate.so")}, folder.path());
  EXPECT_EQ(by_file.status, 1);
  expect_mentions(by_file.errors, {"registered twice", "rk4.so"});
}

/// An unreadable manifest must not stop commands that do not need its module.
TEST(Modules, ABrokenManifestOnThePathIsWarnedOfAndItsModuleLeftOut) {
  const TemporaryFolder folder;
  fs::create_directory(folder.file("more"));
  fs::copy_file(broken("duplicate"), folder.file("more/mine.so"));
  folder.write("more/mine.toml", "manifest = [");
  const std::vector<std::string> path = {"BUTEE_PLUGIN_PATH=" + folder.file("more")};
  const std::vector<std::string> warning = {"warning", "more/mine.so: is ignored", "more/mine.toml:1: not valid TOML"};
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"plugins"}, {"help", "loads"}, {"check", model_path("beam1")}}) {
    const auto outcome = run_program(command, folder.path(), path);
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    expect_mentions(outcome.errors, warning);
  }
  const auto run = run_program({"run", model_path("oscillator"), "--set", "integrator.type=rk4", "--set",
                                "integrator.end_time=1e-3", "-o", "out"},
                               folder.path(), path);
  EXPECT_EQ(run.status, 0) << run.errors;
  for (const std::string set : {"integrator.type=mine", "contact[0].law=mine", "load[0].type=mine",
                                "element[0].type=mine", "output.formats=[\"mine\"]"}) {
    const auto needs = run_program({"check", model_path("oscillator"), "--set", set}, folder.path(), path);
    EXPECT_EQ(needs.status, 2) << set;
    expect_mentions(needs.errors, {"may belong to a module that could not be read", "more/mine.so: is ignored"});
  }
  // If the module is named explicitly, its manifest must be valid.
  const auto named = run_program({"plugins", "--plugin", folder.file("more/mine.so")}, folder.path());
  EXPECT_EQ(named.status, 2);
  expect_mentions(named.errors, {"more/mine.toml:1: not valid TOML"});
}

}  // namespace
}  // namespace butee::test::modules_test
