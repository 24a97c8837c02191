// Dissipative laws from modules: one of butee, and one that distinguishes approach from rebound.
#include <cmath>

#include <butee/config/toml.hpp>
#include <butee/core/error.hpp>
#include <butee/plugin/catalogue.hpp>
#include <butee/scene/assembly.hpp>
#include <gtest/gtest.h>

#include "support/scene_run.hpp"

namespace butee::test::viscoelastic_law_test {
namespace {

/// F = k g (1 + a g') in approach and k g in rebound.
class OneWay final : public model::BatchedLaw<OneWay> {
 public:
  static constexpr double kStiffness = 1e5;
  explicit OneWay(double factor) : factor_(factor) {}
  double secant(double g) const override { return g > 0.0 ? kStiffness : 0.0; }
  double tangent(double g) const override { return secant(g); }
  double energy(double g) const override { return 0.5 * secant(g) * g * g; }
  double closed_stiffness() const override { return kStiffness; }
  RateDependence rate_dependence() const override { return RateDependence::by_sense; }
  RatedForce rated_force(double g, double rate, bool recedes) const override {
    const double a = recedes ? 0.0 : factor_;
    return {kStiffness * g * (1.0 + a * rate), kStiffness * (1.0 + a * rate), kStiffness * g * a};
  }

 private:
  double factor_;
};

/// A catalogue with the modules of the build tree and the law `one_way`.
const plugin::Catalogue& catalogue() {
  static const plugin::Catalogue instance = [] {
    plugin::Catalogue made;
    made.add(BUTEE_TEST_PLUGINS);
    plugin::ModuleTypes own;
    own.laws.push_back({"one_way",
                        "dissipates only during approach",
                        {config::number("factor", "s/m", "a").at_least(0)},
                        [](const config::Parameters& p, config::Diagnostics&) -> std::unique_ptr<model::ContactLaw> {
                          return std::make_unique<OneWay>(p.number("factor"));
                        }});
    made.add(std::move(own), "this test");
    return made;
  }();
  return instance;
}

scene::Scene scene_of(double mass, double speed, const std::string& contact, const std::string& method) {
  return scene::read_scene(
      config::parse_toml("schema = 1\n[[element]]\ntype = \"mass\"\nname = \"ball\"\nmass = " + std::to_string(mass) +
                             "\n[initial]\nvelocity = [{ nodes = \"ball\", value = " + std::to_string(speed) +
                             " }]\n[[contact]]\ntype = \"stop\"\nsides = \"positive\"\nnodes = \"ball\"\ngap = 1e-3\n" +
                             contact + "\n[integrator]\nend_time = 0.2\n" + method,
                         "scene.toml"),
      catalogue());
}

/// The speed after an impact over the speed before it.
double restitution(double mass, double speed, const std::string& contact, const std::string& method) {
  scene::Scene scene = scene_of(mass, speed, contact, method);
  scene::Assembly assembly(scene);
  EXPECT_TRUE(assembly.simulation.run().completed) << assembly.simulation.report().message;
  return -assembly.simulation.state().v[0] / speed;
}

constexpr const char* kTight = "tolerance = 1e-10\n";
const std::string kExplicit[] = {std::string("type = \"dopri5\"\n") + kTight,
                                 std::string("type = \"extrapolation8\"\n") + kTight, kTight};

/// A law may not take keys of the contact for its own.
TEST(LawParameters, ThatContactsHaveAreRefused) {
  for (const std::string key : {"sides", "gap", "nodes", "law"}) {
    plugin::Catalogue with;
    plugin::ModuleTypes own;
    own.laws.push_back({"taken",
                        "a law of this test",
                        {config::number(key, "1", "its own").or_else(1.0)},
                        [](const config::Parameters&, config::Diagnostics&) -> std::unique_ptr<model::ContactLaw> {
                          return std::make_unique<OneWay>(0.0);
                        }});
    with.add(BUTEE_TEST_PLUGINS);
    with.add(std::move(own), "this test");
    try {
      scene::read_scene(config::parse_toml("schema = 1\n[[element]]\ntype = \"mass\"\nname = \"ball\"\nmass = "
                                           "1.0\n[[contact]]\ntype = \"stop\"\nnodes = \"ball\"\ngap = 1e-3\nlaw = "
                                           "\"taken\"\n[integrator]\nend_time = 0.2\n",
                                           "scene.toml"),
                        with);
      FAIL() << key << " was taken";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("scene.toml:10: contact[0].law: taken declares the parameter " + key),
                std::string::npos)
          << error.what();
    }
  }
}

/// e = 1 - 1.153449 b + 0.798267 b^2 + O(b^(5/2)) (Schwager and Poeschel 2008), with b = 3/2 A (k/m)^(2/5) v^(1/5).
TEST(ViscoelasticLaw, HasTheRestitutionOfViscoelasticSpheres) {
  const double mass = 2.0, stiffness = 1e8;
  for (const std::string& method : kExplicit)
    for (const double speed : {0.25, 2.0}) {
      const double b = 1e-3, relaxation = b / (1.5 * std::pow(stiffness / mass, 0.4) * std::pow(speed, 0.2));
      char contact[200];
      std::snprintf(contact, sizeof contact, "law = \"viscoelastic\"\nstiffness = %.17g\nrelaxation = %.17g", stiffness,
                    relaxation);
      // b^(5/2) = 3e-8, with a factor below 0.3.
      EXPECT_NEAR(restitution(mass, speed, contact, method), 1.0 - 1.153449 * b + 0.798267 * b * b, 2e-8)
          << method << speed;
    }
}

/// Approach: d_max^2 = 2 m/(k a^2) (s - ln(1 + s)) with s = a v; the rebound is elastic, e = d_max sqrt(k/m)/v.
TEST(LawThatTellsRebound, HasTheRestitutionOfItsApproach) {
  for (const std::string& method :
       {kExplicit[0], kExplicit[1], kExplicit[2], std::string("type = \"rodas4\"\n") + kTight})
    for (const double s : {0.2, 2.0}) {
      const double speed = 0.5, e = std::sqrt(2.0 * (s - std::log1p(s))) / s;
      EXPECT_NEAR(restitution(2.0, speed, "law = \"one_way\"\nfactor = " + std::to_string(s / speed), method), e, 1e-8)
          << method << s;
    }
}

TEST(LawThatDissipates, IsRefusedWhereItCannotBeTreated) {
  const std::string law = "law = \"viscoelastic\"\nstiffness = 1e8\nrelaxation = 1e-5\n";
  const auto why = [](const std::string& contact, const std::string& method) -> std::string {
    try {
      scene::Scene scene = scene_of(1.0, 1.0, contact, method);
      scene::Assembly assembly(scene);
      return "";
    } catch (const InputError& error) {
      return error.what();
    }
  };
  for (const char* method : {"rodas4", "exact", "piecewise"})
    EXPECT_NE(why(law, "type = \"" + std::string(method) + "\"\n").find("dopri5"), std::string::npos) << method;
  EXPECT_NE(why(law + "damping = { type = \"kelvin_voigt\", coefficient = 3.0 }\n", "")
                .find("conflicts with law = \"viscoelastic\", which has its own dissipation"),
            std::string::npos);
  EXPECT_EQ(why(law, "type = \"rk4\"\ntime_step = 1e-6\n"), "");
}

}  // namespace
}  // namespace butee::test::viscoelastic_law_test
