#include <algorithm>
#include <map>

#include <butee/plugin/catalogue.hpp>
#include <gtest/gtest.h>

#include "apps/conformance/allocation_count.hpp"
#include "apps/conformance/check.hpp"
#include "conformance/methods.hpp"
#include "support/program.hpp"

namespace butee::test::suite_test {
namespace {

using conformance::Check;

/// The suite of `butee test-plugin`, applied to every method of the catalogue.
class Suite : public testing::TestWithParam<std::tuple<MethodCase, Check>> {};

TEST_P(Suite, DemandIsMet) {
  const auto& [method, check] = GetParam();
  plugin::Catalogue catalogue;
  catalogue.add(BUTEE_TEST_PLUGINS);
  const conformance::Finding finding = check.run({catalogue, "integrator", method.name, method.keys});
  EXPECT_TRUE(finding.passed) << check.demand << ": " << finding.details;
}

std::string name_of(const testing::TestParamInfo<std::tuple<MethodCase, Check>>& one) {
  std::string name = std::get<0>(one.param).name + "_" + std::get<1>(one.param).name;
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Catalogue, Suite,
                         testing::Combine(testing::ValuesIn(method_cases()),
                                          testing::ValuesIn(conformance::integrator_checks())),
                         name_of);

/// The same for laws, contacts, loads and elements, including those of the library.
TEST(SuiteOfOtherKinds, DemandsAreMet) {
  plugin::Catalogue catalogue;
  catalogue.add(BUTEE_TEST_PLUGINS);
  const TemporaryFolder folder;
  folder.write("m.mtx", "%%MatrixMarket matrix array real symmetric\n2 2\n2.0\n0.5\n3.0\n");
  folder.write("k.mtx", "%%MatrixMarket matrix array real symmetric\n2 2\n200.0\n-50\n300.0\n");
  const std::map<std::string, std::string> keys = {
      {"linear", "stiffness = 1e6\n"},
      {"arctan", "stiffness = 1e6\nregularization = 7e7\n"},
      {"smooth", "stiffness = 1e6\nwidth = 1e-4\n"},
      {"viscoelastic", "stiffness = 1e9\nrelaxation = 1e-4\n"},
      {"ring", "centre = [0.002, -0.001]\n"},
      {"plane", "normal = [0.6, 0.8]\n"},
      {"harmonic", "amplitude = 3.0\nangular_frequency = 7.0\nphase = 0.4\n"},
      {"constant", "value = -2.0\n"},
      {"ramp", "from = 0.5\nto = 2.0\nstart = 0.3\nend = 0.7\n"},
      {"table", "times = [0.0, 0.2, 0.9]\nvalues = [1.0, -1.0, 4.0]\n"},
      {"unbalance", "moment = 0.1\nspeed = 11.0\n"},
      {"hertz", "stiffness = 1e6\nexponent = 1.5\n"},
      {"beam", "name = \"more\"\nmaterial = \"steel\"\nsection = \"pipe\"\nlength = 3.0\nelements = 5\n"},
      {"mass", "node = \"string:1\"\nmass = 2.0\nrotary_inertia = 0.1\n"},
      {"disc", "node = \"string:1\"\nmass = 2.0\ndiametral_inertia = 0.1\npolar_inertia = 0.15\n"},
      {"bearing",
       "node = \"string:1\"\nstiffness = [[1e4, 2e3], [0, 3e4]]\n"
       // A planar beam has no mass along uz.
       "[[element]]\ntype = \"disc\"\nnode = \"string:1\"\nmass = 1.0\n"},
      {"matrices", "name = \"own\"\nmass = \"" + folder.file("m.mtx") + "\"\nstiffness = \"" + folder.file("k.mtx") +
                       "\"\nnodes = [\"own:0\", \"a\"]\ndofs = \"u\"\n"},
      {"spring", "nodes = [\"a\", \"string:2\"]\nstiffness = 1e4\ndamping = 3.0\n"}};
  int count = 0;
  const auto test = [&](const std::string& kind, const std::vector<std::string>& names) {
    for (const std::string& name : names) {
      ASSERT_TRUE(keys.contains(name)) << kind << " " << name << " has no keys here";
      for (const Check& check : conformance::checks_of(kind)) {
        const conformance::Finding finding = check.run({catalogue, kind, name, keys.at(name)});
        EXPECT_TRUE(finding.passed) << name << ": " << check.demand << ": " << finding.details;
        ++count;
      }
    }
  };
  test("law", model::type_names(catalogue.types().laws));
  test("contact", model::type_names(catalogue.types().contacts));
  test("load", model::type_names(catalogue.types().loads));
  test("element", model::type_names(catalogue.types().elements));
  EXPECT_EQ(count, 5 * 6 + 2 * 4 + 5 * 6 + 6 * 2);
}

#ifndef __SANITIZE_ADDRESS__
TEST(Allocation, IsCounted) {
  const long before = conformance::allocation_count();
  const std::vector<double> something(1000);
  EXPECT_EQ(something.size(), 1000U);
  EXPECT_GT(conformance::allocation_count() - before, 0);
}
#endif

TEST(ConformanceSuite, CoversTheWholeCatalogue) {
  plugin::Catalogue catalogue;
  catalogue.add(BUTEE_TEST_PLUGINS);
  std::vector<std::string> registered, covered;
  // SUNDIALS keeps its own history, so its steps are not pure functions; see tests/plugins/sundials_test.cpp.
  for (const auto& entry : catalogue.integrators())
    if (entry.module.find("sundials") == std::string::npos) registered.push_back(entry.declaration.name);
  for (const MethodCase& method : method_cases()) covered.push_back(method.name);
  std::sort(registered.begin(), registered.end());
  std::sort(covered.begin(), covered.end());
  EXPECT_EQ(registered, covered);
}

/// A name that no type of the module has is refused before the first check.
TEST(SuiteOfOtherKinds, NamesOfTheRequestExist) {
  const TemporaryFolder folder;
  const auto refusal_of = [&](const std::string& option, const std::string& value) {
    const auto result =
        run_program({"test-plugin", std::string(BUTEE_TEST_PLUGINS) + "/smooth.so", option, value}, folder.path());
    EXPECT_EQ(result.status, 2) << value;
    return result.errors;
  };
  EXPECT_NE(refusal_of("--set", "widht=1e-4").find("a parameter widht (did you mean \"width\"?)"), std::string::npos);
  EXPECT_NE(refusal_of("--only", "smoth").find("has no type of this name (did you mean \"smooth\"?)"),
            std::string::npos);
}

}  // namespace
}  // namespace butee::test::suite_test
