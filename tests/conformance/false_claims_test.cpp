// The suite of `butee test-plugin` refuses types whose statements about themselves are false.
#include <array>
#include <cmath>

#include <butee/plugin/catalogue.hpp>
#include <gtest/gtest.h>

#include "apps/conformance/check.hpp"

namespace butee::test::false_claims_test {
namespace {

using config::Diagnostics;
using config::Parameters;

/// F = k g^2, called piecewise linear.
class Square final : public model::BatchedLaw<Square> {
 public:
  double secant(double g) const override { return g > 0.0 ? 1e6 * g : 0.0; }
  double tangent(double g) const override { return g > 0.0 ? 2e6 * g : 0.0; }
  double energy(double g) const override { return g > 0.0 ? 1e6 * g * g * g / 3.0 : 0.0; }
  double closed_stiffness() const override { return 1e6; }
  bool is_piecewise_linear() const override { return true; }
};

/// A function of time that claims to be made of parabolas, without discontinuities.
class Claimed final : public model::TimeFunction {
 public:
  explicit Claimed(double (*function)(double)) : function_(function) {}
  double value(double t) const override { return function_(t); }
  bool is_piecewise_parabolic() const override { return true; }

 private:
  double (*function_)(double);
};

/// A mass and a spring to ground on one node.
class Lone final : public model::Element {
 public:
  Lone(model::NodeId node, double mass, double stiffness) : node_(node), mass_(mass), stiffness_(stiffness) {}
  void claim(model::DofTable& dofs) const override { dofs.claim({node_, DofKind::u}, true); }
  void assemble(model::MatrixSink& sink) const override {
    model::ElementMatrices matrices(1);
    matrices.mass(0, 0) = mass_;
    matrices.stiffness(0, 0) = stiffness_;
    sink.add(std::array{model::NodalDof{node_, DofKind::u}}, matrices);
  }

 private:
  model::NodeId node_;
  double mass_, stiffness_;
};

/// A circle that calls itself a line.
class Circle final : public model::ContactShape {
 public:
  model::Approach at(const Eigen::Vector2d& d) const override {
    return {d.norm() - 0.01, d.normalized(), 1.0 / d.norm()};
  }
  Form form() const override { return {Form::Kind::line, {1.0, 0.0}, 0.01}; }
};

plugin::Catalogue catalogue_of_false_claims() {
  plugin::ModuleTypes types;
  types.laws.push_back({"square", "", {}, [](const Parameters&, Diagnostics&) { return std::make_unique<Square>(); }});
  const auto add_load = [&](const char* name, double (*value)(double)) {
    types.loads.push_back(
        {name, "", {}, [value](const Parameters&, Diagnostics&) { return std::make_unique<Claimed>(value); }});
  };
  add_load("sine", [](double t) { return 100.0 * std::sin(60.0 * t); });
  add_load("kink", [](double t) { return std::abs(t - 0.4321); });
  add_load("jump", [](double t) { return t < 0.0123 ? 0.0 : 1.0; });
  const auto add_element = [&](const char* name, double mass, double stiffness) {
    types.elements.push_back({name,
                              "",
                              {config::text("node", "its node")},
                              [](const Parameters&, Diagnostics&) -> model::ElementType::Nodes { return {}; },
                              [=](const Parameters& p, model::ElementContext& context) {
                                return std::make_unique<Lone>(*context.node(p, "node"), mass, stiffness);
                              }});
  };
  add_element("light", -1e-3, 0.0);
  add_element("soft", 0.0, -10.0);
  types.contacts.push_back(
      {"circle", "", {}, [](const Parameters&, double, Diagnostics&) { return std::make_unique<Circle>(); }});
  plugin::Catalogue catalogue;
  catalogue.add(BUTEE_TEST_PLUGINS);
  // The classical Runge-Kutta method is stable up to h omega = 2.83 and h c/m = 2.79.
  const auto add_method = [&](const char* name, double stability, double damping) {
    time::IntegratorType method = catalogue.load("rk4");
    method.name = name;
    method.aliases.clear();
    method.stability_limit = stability;
    method.damping_limit = damping;
    types.integrators.push_back(std::move(method));
  };
  add_method("bold", 3.5, 2.785);
  add_method("timid", 1.5, 2.785);
  add_method("brakeless", 2.828, INFINITY);
  catalogue.add(std::move(types), "this test");
  return catalogue;
}

TEST(SuiteOfOtherKinds, FindsFalseClaims) {
  struct Case {
    const char *kind, *name, *keys, *check;
  };
  const plugin::Catalogue catalogue = catalogue_of_false_claims();
  for (const Case& one :
       {Case{"law", "square", "", "series"}, Case{"load", "sine", "", "parabolas"},
        Case{"load", "kink", "", "parabolas"}, Case{"load", "jump", "", "values"},
        Case{"element", "light", "node = \"a\"\n", "matrices"}, Case{"element", "soft", "node = \"a\"\n", "matrices"},
        Case{"contact", "circle", "", "form"}, Case{"integrator", "bold", "", "stability"},
        Case{"integrator", "timid", "", "stability"}, Case{"integrator", "brakeless", "", "stability"}}) {
    bool is_refused = false;
    for (const conformance::Check& check : conformance::checks_of(one.kind))
      if (check.name == one.check) is_refused = !check.run({catalogue, one.kind, one.name, one.keys}).passed;
    EXPECT_TRUE(is_refused) << one.name;
  }
}

}  // namespace
}  // namespace butee::test::false_claims_test
