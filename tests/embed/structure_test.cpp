#include <cmath>
#include <numeric>
#include <thread>

#include <butee/config/model_builder.hpp>
#include <butee/core/error.hpp>
#include <butee/embed/structure.hpp>
#include <gtest/gtest.h>

#include "conformance/methods.hpp"
#include "support/scene_run.hpp"

namespace butee::test::structure_test {
namespace {

using embed::Structure;
using embed::StructureOptions;

/// A mass on a spring beside a stop, with an external force.
std::string oscillator(const std::string& integrator) {
  return "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 2.0\n"
         "[[element]]\ntype = \"spring\"\nnode = \"m\"\nstiffness = 800.0\ndamping = 1.5\n" +
         integrator;
}

const std::string kExact = "[integrator]\ntype = \"exponential\"\ntolerance = 1e-10\n";

StructureOptions with_plugins(StructureOptions options = {}) {
  options.plugins = {BUTEE_TEST_PLUGINS};
  return options;
}

/// A scene of the paper in one call of advance_to, and in calls of different lengths.
TEST(Structure, AdvancesAsAWholeRunDoes) {
  constexpr double kEnd = 0.05;
  for (const std::string method : {"exponential", "rodas4", "newmark_modified", "rk4"}) {
    SceneRun whole = SceneRun::of_model("beam3", {"integrator.type=" + method, "integrator.end_time=0.05"});
    ASSERT_TRUE(whole.run().completed);
    Structure beam =
        Structure::from_file(model_path("beam3"), with_plugins({.overrides = {"integrator.type=" + method}}));
    for (const double t : {0.0101, 0.0102, 0.0307, kEnd}) {
      beam.advance_to(t);
      EXPECT_EQ(beam.time(), t);
    }
    const Vector& x = whole.simulation().state().x;
    // Splitting the run changes adaptive steps within their tolerances, and shortens fixed steps.
    EXPECT_LT((beam.state().x - x).lpNorm<Eigen::Infinity>(), 3e-3 * x.lpNorm<Eigen::Infinity>()) << method;
  }
}

/// m x'' + c x' + k x = f from rest, f piecewise constant: closed form with a force that changes at 0.1 s.
TEST(Structure, FeelsForcesThatAreSetBetweenSteps) {
  for (const std::string method :
       {"exponential", "rodas4", "newmark", "rk4", "dopri5", "generalized_alpha_adaptive", "exact"}) {
    const std::string keys =
        method == "newmark" ? "residual_tolerance = 1e-12\nincrement_tolerance = 1e-12\nmax_iterations = 9\n" : "";
    Structure mass =
        Structure::from_toml(oscillator("[integrator]\ntype = \"" + method + "\"\ntime_step = 1e-4\n" + keys),
                             with_plugins({.forced = {"m"}}));
    const Index dof = mass.dof("m");
    const double d = 1.5 / 4.0, w = std::sqrt(400.0 - d * d);
    const auto step_response = [&](double t) {
      return t <= 0.0 ? 0.0 : (1.0 - std::exp(-d * t) * (std::cos(w * t) + d / w * std::sin(w * t))) / 800.0;
    };
    mass.set_force(dof, 30.0);
    mass.advance_to(0.1);
    EXPECT_EQ(mass.force(dof), 30.0);
    mass.set_force(dof, -12.0);
    mass.advance_to(0.25);
    const double expected = 30.0 * step_response(0.25) - 42.0 * step_response(0.15);
    // Second order with h omega = 2e-3, or the default tolerances.
    EXPECT_NEAR(mass.displacement(dof), expected, 2e-4 * 30.0 / 800.0) << method;
  }
}

/// Forces and moments on all six DOFs of a frame's corner, set by the caller and by the scene.
TEST(Structure, IsPushedAlongAndAboutEveryAxis) {
  const std::string frame =
      "schema = 1\n[material.steel]\nyoung_modulus = 2e11\ndensity = 7850.0\npoisson_ratio = 0.3\n"
      "[section.bar]\nshape = \"rectangle\"\nwidth = 0.03\nheight = 0.06\n[[element]]\ntype = \"beam\"\n"
      "name = \"post\"\nmotion = \"spatial\"\nmaterial = \"steel\"\nsection = \"bar\"\nelements = 2\n"
      "points = [[0, 0, 0], [0.3, 1, 0.2]]\nup = [0, 0, 1]\n[[support]]\nnodes = \"post:first\"\nfix = [\"ux\", "
      "\"uy\", \"uz\", \"rx\", \"ry\", \"rz\"]\n[integrator]\ntype = \"exact\"\nend_time = 0.02\n";
  std::string loads;
  for (const DofKind kind : kAllDofKinds) {
    const std::string name(kDofNames[2 + static_cast<std::size_t>(kind)]);  // ux ... rz
    loads += "[[load]]\ntype = \"constant\"\nnode = \"post:last\"\ndof = \"" + name +
             "\"\nvalue = " + std::to_string(10.0 + static_cast<int>(kind)) + "\n";
  }
  const StructureOptions options = with_plugins(
      {.forced = {"post:last.ux", "post:last", "post:last.w", "post:last.rx", "post:last.ry", "post:last.theta"}});
  Structure post = Structure::from_toml(frame, options);
  for (const DofKind kind : kAllDofKinds) post.set_force(post.dof("post:last", kind), 10.0 + static_cast<int>(kind));
  SceneRun whole(frame + loads);
  ASSERT_TRUE(whole.run().completed);
  post.advance_to(0.02);
  const Vector& x = whole.simulation().state().x;
  for (const DofKind kind : kAllDofKinds) {
    const Index dof = whole.dof("post:last", kind);
    ASSERT_GT(std::abs(x[dof]), 1e-7);
    EXPECT_NEAR(post.displacement(post.dof("post:last", kind)), x[dof], 1e-10 * x.lpNorm<Eigen::Infinity>())
        << name_of(kind);
  }
  EXPECT_THROW(Structure::from_toml(frame, with_plugins({.forced = {"post:last", "post:first.uz"}})), InputError);
}

/// A linearly varying force: x = (t - sin(w t)/w) slope/k without damping.
TEST(Structure, FollowsForcesInStraightLinesExactly) {
  Structure mass = Structure::from_toml(
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 2.0\n[[element]]\ntype = \"spring\"\nnode = "
      "\"m\"\nstiffness = 800.0\n" +
          kExact,
      with_plugins({.forced = {"m"}}));
  const Index dof = mass.dof("m");
  double t = 0.0;
  for (const double next : {0.01, 0.03, 0.1, 0.17}) {
    mass.set_force(dof, 50.0 * t, 50.0 * next, next);
    mass.advance_to(t = next);
  }
  EXPECT_NEAR(mass.displacement(dof), (t - std::sin(20.0 * t) / 20.0) * 50.0 / 800.0, 1e-13);
}

/// A body that sticks, k = 1 N/m and 1000 N/m of its stick spring; the limit of 10 N is never reached. Changes of the
/// force and of the motion leave the spring as it is.
TEST(Structure, KeepsTheFrictionForceWhenALoadIsSet) {
  const std::string scene =
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 2.0\n[[element]]\ntype = \"spring\"\nnode = "
      "\"m\"\nstiffness = 1.0\ndamping = 40.0\n[[contact]]\ntype = \"friction\"\nnodes = \"m\"\nnormal_force = 20.0\n"
      "friction = { coefficient = 0.5, stick_stiffness = 1e3 }\n[integrator]\ntolerance = 1e-7\ntype = \"";
  for (const std::string method : {"rodas4", "dopri5", "exact"}) {
    Structure body = Structure::from_toml(scene + method + "\"\n", with_plugins({.forced = {"m"}}));
    const Index dof = body.dof("m");
    for (int i = 1; i <= 40; ++i) {
      body.set_force(dof, 4.0 + (i % 2 == 0 ? 0.01 : -0.01));
      body.advance_to(0.05 * i);
      body.set_motion(Vector(body.state().x), Vector(body.state().v));
    }
    EXPECT_NEAR(body.displacement(dof), 4.0 / 1001.0, 2e-5) << method;
  }
}

/// Two masses that a spring joins, the first at rest in the middle of a stop whose law pulls it to the nearer side with
/// a residual force of 1 N. A force on the second one grows from zero, after a step without any.
TEST(Structure, LeavesTheMiddleOfAStopWithAForceThatGrows) {
  constexpr double kBegin = 0.1, kEnd = 0.5, kSlope = 4.0, kResidual = 1.0, kStiffness = 100.0, kTolerance = 1e-5;
  const std::string scene =
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"a\"\nmass = 1.0\n[[element]]\ntype = \"mass\"\nname = "
      "\"b\"\nmass = 1.0\n[[element]]\ntype = \"spring\"\nnodes = [\"a\", \"b\"]\nstiffness = 100.0\n[[contact]]\ntype "
      "= "
      "\"stop\"\nnodes = \"a\"\ngap = 1.0\nlaw = \"arctan\"\nregularization = 1e3\nstiffness = 9869.604401089358\n"
      "[integrator]\nend_time = 0.5\ntolerance = 1e-5\ntype = \"";
  const double omega = std::sqrt(2.0 * kStiffness), t = kEnd - kBegin;
  const double apart =
      (kSlope * t - kResidual * (1.0 - std::cos(omega * t)) - kSlope / omega * std::sin(omega * t)) / (omega * omega);
  const double expected = kSlope * t * t * t / 12.0 + 0.25 * kResidual * t * t - 0.5 * apart;
  for (const std::string method : {"rodas4", "dopri5", "bathe_adaptive", "generalized_alpha_adaptive"})
    for (const double side : {1.0, -1.0}) {
      Structure masses = Structure::from_toml(scene + method + "\"\n", with_plugins({.forced = {"b"}}));
      masses.advance_to(kBegin);
      EXPECT_EQ(masses.state().x[masses.dof("a")], 0.0);
      masses.set_force(masses.dof("b"), 0.0, side * kSlope * t, kEnd);
      masses.advance_to(kEnd);
      EXPECT_NEAR(masses.state().x[masses.dof("a")], side * expected, 10.0 * kTolerance * expected) << method;
    }
}

TEST(Structure, GoesBackToASnapshotBitForBit) {
  for (const MethodCase& method : method_cases()) {
    const std::string text = with_linear_law("beam3");
    StructureOptions options = with_plugins({.overrides = {"integrator.type=" + method.name}, .forced = {"string:5"}});
    if (method.is_for_few_dofs) options.overrides.emplace_back("element[0].elements=8");
    Structure beam = Structure::from_toml(text, options);
    const Index dof = beam.dof("string:5");
    beam.set_force(dof, 100.0);
    beam.advance_to(2e-3);
    const Structure::Snapshot before = beam.snapshot();
    const auto go_on = [&] {
      beam.set_force(dof, 100.0, 700.0, 4e-3);
      beam.advance_to(4e-3);
      return beam.state().x;
    };
    const Vector first = go_on();
    beam.set_force(dof, -1e4);
    beam.advance_to(5e-3);
    beam.restore(before);
    EXPECT_EQ(beam.time(), 2e-3);
    EXPECT_EQ(beam.force(dof), 100.0);
    EXPECT_TRUE(first == go_on()) << method.name;
  }
}

/// A body pressed against a dissipative stop that a stick spring and the stop hold: a snapshot taken while both touch
/// goes on alike, with the same forces, in the structure itself and in a new one.
TEST(Structure, ContinuesContactsFromASnapshot) {
  const std::string scene =
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 2.0\n[[element]]\ntype = \"spring\"\nnode = "
      "\"m\"\nstiffness = 100.0\n[[contact]]\ntype = \"stop\"\nnodes = \"m\"\ngap = 0.001\nstiffness = 1e4\ndamping = "
      "{ type = \"hunt_crossley\", factor = 5.0 }\n[[contact]]\ntype = \"friction\"\nnodes = \"m\"\nnormal_force = "
      "20.0\nfriction = { coefficient = 0.5, stick_stiffness = 1e4, stick_damping = 5.0 }\n[[load]]\ntype = "
      "\"harmonic\"\nnode = \"m\"\namplitude = 60.0\nangular_frequency = 20.0\nphase = 1.57\n[integrator]\ntolerance = "
      "1e-7\ntype = \"";
  for (const std::string method : {"auto", "rodas4", "dopri5", "extrapolation8", "exact", "exponential"}) {
    Structure body = Structure::from_toml(scene + method + "\"\n", with_plugins());
    const Index dof = body.dof("m");
    body.advance_to(0.04);
    const double force = body.contact_force(dof), friction = body.quantity("friction_force", "m");
    EXPECT_GT(std::abs(force), 1.0) << method;
    const Structure::Snapshot before = body.snapshot();
    body.advance_to(0.5);
    const Vector end = body.state().x;
    Structure other = Structure::from_toml(scene + method + "\"\n", with_plugins());
    for (Structure* one : {&body, &other}) {
      one->restore(before);
      EXPECT_EQ(one->contact_force(dof), force) << method;
      EXPECT_EQ(one->quantity("friction_force", "m"), friction) << method;
      one->advance_to(0.5);
      EXPECT_EQ(one->state().x, end) << method;
    }
  }
}

TEST(Structure, TakesAnotherMotion) {
  Structure mass = Structure::from_toml(oscillator(kExact), with_plugins());
  const Index dof = mass.dof("m");
  mass.advance_to(0.1);
  mass.set_displacement(dof, 0.02);
  mass.set_velocity(dof, -0.3);
  EXPECT_EQ(mass.displacement(dof), 0.02);
  EXPECT_NEAR(mass.acceleration(dof), (-800.0 * 0.02 + 1.5 * 0.3) / 2.0, 1e-12);
  mass.advance_to(0.3);
  const double d = 1.5 / 4.0, w = std::sqrt(400.0 - d * d), t = 0.2;
  EXPECT_NEAR(mass.displacement(dof),
              std::exp(-d * t) * (0.02 * std::cos(w * t) + (-0.3 + d * 0.02) / w * std::sin(w * t)), 1e-12);
}

TEST(Structure, TakesStepsOfTheMethod) {
  Structure mass = Structure::from_toml(oscillator("[integrator]\ntype = \"rk4\"\ntime_step = 1e-3\n"), with_plugins());
  EXPECT_EQ(mass.advance_step(1.0), 1e-3);
  EXPECT_EQ(mass.advance_step(1.0), 2e-3);
  EXPECT_EQ(mass.advance_step(2.5e-3), 2.5e-3);
  EXPECT_EQ(mass.report().steps, 3);
}

TEST(Structure, SaysWhatIsWrong) {
  Structure mass = Structure::from_toml(oscillator(kExact), with_plugins());
  EXPECT_THROW(mass.dof("n"), InputError);
  EXPECT_THROW(mass.dof("m", DofKind::theta), InputError);
  EXPECT_THROW(mass.set_force(mass.dof("m"), 1.0), InputError);
  EXPECT_THROW(mass.advance_to(-1.0), LogicError);
  EXPECT_THROW(Structure::from_toml("schema = 1\n[integrator]\ntype = \"rk5\"\n", with_plugins()), InputError);
  EXPECT_THROW(Structure::from_toml(oscillator(kExact), with_plugins({.forced = {"nobody"}})), InputError);
  EXPECT_THROW(Structure::from_toml(oscillator(kExact), with_plugins({.forced = {"m", "m.u"}})), InputError);
  // A failed run keeps the state of the last good step and does not continue.
  Structure lost = Structure::from_toml(oscillator("[integrator]\ntype = \"rk4\"\ntime_step = 1.0\n"),
                                        with_plugins({.forced = {"m"}}));
  lost.set_force(0, 1e90);
  EXPECT_THROW(lost.advance_to(1e4), RunError);
  EXPECT_TRUE(lost.state().x.allFinite());
  EXPECT_THROW(lost.advance_to(2e4), RunError);
}

/// Structures share no data: many on separate threads give the same bits as one alone. The preset tsan
/// detects data races.
TEST(Structure, LivesOnManyThreads) {
  const auto run = [](const std::string& method) {
    Structure beam =
        Structure::from_toml(with_linear_law("beam3"), with_plugins({.overrides = {"integrator.type=" + method}}));
    beam.advance_to(5e-3);
    return beam.state().x;
  };
  const std::vector<std::string> methods = {"exponential", "rodas4", "newmark_modified",
                                            "NM2",         "exact",  "extrapolation8"};
  std::vector<Vector> alone, together(methods.size());
  for (const std::string& method : methods) alone.push_back(run(method));
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < methods.size(); ++i) threads.emplace_back([&, i] { together[i] = run(methods[i]); });
  for (std::thread& thread : threads) thread.join();
  for (std::size_t i = 0; i < methods.size(); ++i) EXPECT_TRUE(alone[i] == together[i]) << methods[i];
}

/// The same structure from keys in code, from their TOML text, and from a hand-written text.
TEST(ModelBuilder, MakesTheStructureOfAFileWithTheSameKeys) {
  config::ModelBuilder model;
  model.set("material.steel", {{"young_modulus", 2.1e11}, {"density", 7850}})
      .set("section.rod", {{"shape", "circle"}, {"radius", 0.02}})
      .add("element", {{"type", "beam"},
                       {"name", "b"},
                       {"material", "steel"},
                       {"section", "rod"},
                       {"length", 2.0},
                       {"elements", 4}})
      .add("support", {{"nodes", {"b:first", "b:last"}}, {"fix", {"u"}}})
      .add("contact", {{"type", "stop"},
                       {"nodes", "b:middle"},
                       {"sides", "positive"},
                       {"gap", 1e-3},
                       {"law", "linear"},
                       {"stiffness", 1e7}})
      .set("initial", {{"velocity", {config::Keys{{"nodes", "b:middle"}, {"value", 1.5}}}}})
      .set("integrator", {{"type", "exponential"}, {"tolerance", 1e-6}});
  const std::string text = R"(schema = 1
material.steel = {young_modulus = 2.1e11, density = 7850}
section.rod = {shape = "circle", radius = 0.02}
element = [{type = "beam", name = "b", material = "steel", section = "rod", length = 2.0, elements = 4}]
support = [{nodes = ["b:first", "b:last"], fix = ["u"]}]
contact = [{type = "stop", nodes = "b:middle", sides = "positive", gap = 1e-3, law = "linear", stiffness = 1e7}]
initial = {velocity = [{nodes = "b:middle", value = 1.5}]}
integrator = {type = "exponential", tolerance = 1e-6}
)";
  Structure by_keys = Structure::from_document(model.document(), with_plugins());
  Structure by_own_text = Structure::from_toml(model.toml(), with_plugins());
  Structure by_hand = Structure::from_toml(text, with_plugins());
  for (Structure* structure : {&by_keys, &by_own_text, &by_hand}) structure->advance_to(0.002);
  EXPECT_NE(by_hand.contact_force(by_hand.dof("b:middle")), 0.0);
  EXPECT_EQ(by_keys.state().x, by_hand.state().x);
  EXPECT_EQ(by_own_text.state().x, by_hand.state().x);
}

TEST(ModelBuilder, SaysInWhichCallAMistakeIs) {
  config::ModelBuilder model;
  model.add("element", {{"type", "mass"}, {"name", "m"}, {"mass", 1.0}})
      .add("element", {{"type", "spring"}, {"node", "m"}, {"stiffness", -4.0}})
      .set("integrator", {{"type", "rk4"}, {"time_step", 1e-3}});
  try {
    Structure::from_document(model.document(), with_plugins());
    FAIL() << "a negative stiffness passed";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("model in code:2: element[1].stiffness = -4"), std::string::npos)
        << error.what();
  }
  const auto complaint_of = [](const auto& call) -> std::string {
    try {
      call();
    } catch (const LogicError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(complaint_of([&] {
              model.set("element.x", {{"y", 1}});
            }),
            "model in code:4: element.x: element is not a table, but an array");
  EXPECT_EQ(complaint_of([&] {
              model.add("integrator", {{"y", 1}});
            }),
            "model in code:5: integrator is not a list, but a table; set() gives keys to a table");
}

/// m x'' = -k x - c x': the spring's force, and the opposite reaction of its support.
TEST(Structure, GivesTheQuantitiesOfProbes) {
  const std::string wall =
      "[[element]]\ntype = \"mass\"\nname = \"wall\"\nmass = 1.0\n[[element]]\ntype = \"spring\"\nname = \"link\"\n"
      "nodes = [\"m\", \"wall\"]\nstiffness = 300.0\n[[support]]\nnodes = \"wall\"\nfix = \"u\"\n";
  Structure mass = Structure::from_toml(oscillator(wall + kExact), with_plugins());
  mass.set_motion(Vector{{0.01}}, Vector{{2.0}});
  EXPECT_DOUBLE_EQ(mass.quantity("spring_force", "m"), -1100.0 * 0.01 - 1.5 * 2.0);
  EXPECT_DOUBLE_EQ(mass.quantity("spring_force", "m", "link"), -3.0);
  EXPECT_DOUBLE_EQ(mass.quantity("reaction", "wall"), -3.0);
  EXPECT_DOUBLE_EQ(mass.quantity("v", "m"), 2.0);
  EXPECT_THROW((void)mass.quantity("M", "m"), InputError);
  EXPECT_THROW((void)mass.quantity("spring_forces", "m"), InputError);
  EXPECT_THROW((void)mass.quantity("reaction", "m"), InputError);
}

}  // namespace
}  // namespace butee::test::structure_test
