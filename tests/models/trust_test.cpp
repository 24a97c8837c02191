// --trust on scenes with solutions in 80-bit arithmetic (support/extended_motion): its stated error bounds
// the true error, its intervals contain the true peaks, and it identifies chaotic scenes.
#include "apps/butee/trust.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <map>
#include <numbers>
#include <ostream>
#include <string>
#include <vector>

#include <butee/core/text.hpp>
#include <gtest/gtest.h>

#include "apps/butee/trust/followed_run.hpp"
#include "support/extended_motion.hpp"
#include "support/scene_run.hpp"

namespace butee::test::trust_test {
namespace {

struct Spring {
  int a, b;  ///< b < 0: to ground
  double stiffness, damping;
};
struct Stop {
  int a, b;
  double gap, stiffness;
  int sides = 0;
  double regularization = 0.0;  ///< of the arctan law, 1/m; 0: linear law
};
struct Load {
  int dof;
  double amplitude, omega, phase = 0.0;
};
enum class Growth { none, exponential };

/// A scene in two forms: for butee and for 80-bit arithmetic.
struct Scene {
  std::string name;
  std::vector<double> mass;
  std::vector<Spring> springs;
  std::vector<Stop> stops;
  std::vector<Load> loads;
  std::vector<double> x0, v0;
  double end_time;
  Growth growth = Growth::none;
  std::string integrator = "tolerance = 1e-5\n";

  std::string toml() const;
  ExtendedSystem extended() const;
};

void PrintTo(const Scene& scene, std::ostream* out) {
  *out << scene.name;
}

std::string node(int dof) {
  return "\"m" + std::to_string(dof) + "\"";
}

std::string Scene::toml() const {
  std::string text = "schema = 1\n";
  const auto ends = [](int a, int b, const char* pair) {
    return b < 0 ? (std::string(pair) == "nodes" ? "node = " : "nodes = ") + node(a) + "\n"
                 : std::string(pair) + " = [" + node(a) + ", " + node(b) + "]\n";
  };
  for (std::size_t i = 0; i < mass.size(); ++i)
    text += "[[element]]\ntype = \"mass\"\nname = " + node(static_cast<int>(i)) + "\nmass = " + to_text(mass[i]) + "\n";
  for (const Spring& s : springs)
    text += "[[element]]\ntype = \"spring\"\n" + ends(s.a, s.b, "nodes") + "stiffness = " + to_text(s.stiffness) +
            "\ndamping = " + to_text(s.damping) + "\n";
  for (const Stop& s : stops) {
    text += "[[contact]]\ntype = \"stop\"\n" + ends(s.a, s.b, "between") + "gap = " + to_text(s.gap) +
            "\nstiffness = " + to_text(s.stiffness) + "\nsides = \"" +
            (s.sides == 0  ? "both"
             : s.sides > 0 ? "positive"
                           : "negative") +
            "\"\n";
    text += s.regularization > 0.0 ? "law = \"arctan\"\nregularization = " + to_text(s.regularization) + "\n"
                                   : "law = \"linear\"\n";
  }
  for (const Load& l : loads)
    text += "[[load]]\ntype = \"harmonic\"\nnode = " + node(l.dof) + "\namplitude = " + to_text(l.amplitude) +
            "\nangular_frequency = " + to_text(l.omega) + "\nphase = " + to_text(l.phase) + "\n";
  text += "[initial]\n";
  for (const auto& [key, values] : {std::pair("displacement", &x0), std::pair("velocity", &v0)}) {
    text += key + std::string(" = [");
    for (std::size_t i = 0; i < values->size(); ++i)
      text += "{ nodes = " + node(static_cast<int>(i)) + ", value = " + to_text((*values)[i]) + " }, ";
    text += "]\n";
  }
  text += "[integrator]\n" + integrator + "end_time = " + to_text(end_time) + "\n[output]\n";
  for (std::size_t i = 0; i < mass.size(); ++i) {
    const std::string mark = node(static_cast<int>(i));
    text += "[[output.probe]]\nlabel = " + mark + "\nnode = " + mark + "\nquantities = [\"u\"]\n";
  }
  return text;
}

ExtendedSystem Scene::extended() const {
  const std::size_t n = mass.size();
  ExtendedSystem system;
  system.mass.assign(mass.begin(), mass.end());
  system.displacement.assign(x0.begin(), x0.end());
  system.velocity.assign(v0.begin(), v0.end());
  system.displacement.resize(n, 0.0L);
  system.velocity.resize(n, 0.0L);
  system.stiffness.assign(n, std::vector<long double>(n, 0.0L));
  system.damping = system.stiffness;
  for (const Spring& s : springs) {
    const auto add = [&](auto& matrix, long double value) {
      const auto a = static_cast<std::size_t>(s.a);
      matrix[a][a] += value;
      if (s.b < 0) return;
      const auto b = static_cast<std::size_t>(s.b);
      matrix[b][b] += value;
      matrix[a][b] -= value;
      matrix[b][a] -= value;
    };
    add(system.stiffness, s.stiffness);
    add(system.damping, s.damping);
  }
  for (const Stop& s : stops)
    system.stops.push_back({s.a, s.b, s.gap, s.stiffness, s.sides, std::numbers::pi_v<long double> * s.regularization});
  for (const Load& l : loads) system.loads.push_back({l.dof, l.amplitude, l.omega, l.phase});
  return system;
}

/// One mass on a spring.
Scene single(const std::string& name, double mass, double stiffness, double damping, std::vector<Stop> stops,
             std::vector<Load> loads, double x0, double v0, double end_time) {
  return {name, {mass}, {{0, -1, stiffness, damping}}, std::move(stops), std::move(loads), {x0}, {v0}, end_time};
}

/// Free motion of one mass: integrable for any stops, so that disturbances grow at most like t.
std::vector<Scene> free_scenes() {
  const auto swing = [](const std::string& name, std::vector<Stop> stops, double v0, double end = 2.0, double c = 0.0) {
    return single(name, 1.0, 1e4, c, std::move(stops), {}, 0.0, v0, end);
  };
  std::vector<Scene> all = {
      swing("free_two_sides", {{0, -1, 1e-3, 1e6}}, 0.3),
      swing("free_one_side", {{0, -1, 1e-3, 1e6, 1}}, 0.3),
      swing("free_hard", {{0, -1, 1e-3, 1e8}}, 0.3),
      swing("free_fast", {{0, -1, 1e-3, 1e6}}, 5.0, 1.0),
      swing("free_long", {{0, -1, 1e-3, 4e5}}, 0.2, 20.0),
      swing("free_without_gap", {{0, -1, 0.0, 1e6}}, 0.3),
      swing("free_one_side_without_gap", {{0, -1, 0.0, 8e4, -1}}, 0.3),
      swing("free_weak_stop", {{0, -1, 1e-3, 1e3}}, 0.3),
      swing("free_two_gaps", {{0, -1, 1e-3, 1e6, 1}, {0, -1, 2e-3, 1e7, -1}}, 0.5),
      swing("free_damped", {{0, -1, 1e-3, 1e6}}, 0.6, 2.0, 2.0),
      swing("free_damped_strongly", {{0, -1, 1e-3, 1e6}}, 0.6, 0.5, 150.0),
      swing("free_open", {{0, -1, 1e-2, 1e6}}, 0.3),
      swing("free_smooth", {{0, -1, 1e-3, 1e6, 1, 5e3}}, 0.3, 0.5),
      swing("free_smooth_two_sides", {{0, -1, 1e-3, 1e6, 0, 2e3}}, 0.3, 0.5),
      single("free_bouncing", 2.0, 1.0, 0.0, {{0, -1, 0.1, 1e6}}, {}, 0.0, 3.0, 2.0),
  };
  Scene pulled = swing("free_smooth_from_rest", {{0, -1, 1e-3, 1e7, 1, 5e4}}, 0.0, 1.0);
  pulled.integrator = "tolerance = 1e-8\n";
  all.push_back(pulled);
  for (const char* method : {"exact", "rk4", "newmark", "newmark_modified", "rodas4", "dopri5"}) {
    Scene scene = swing(std::string("free_by_") + method, {{0, -1, 1e-3, 1e6}}, 0.3, 0.5);
    const bool is_fixed = std::string(method) == "rk4" || std::string(method).starts_with("newmark");
    scene.integrator = "type = \"" + std::string(method) + "\"\n" + (is_fixed ? "time_step = 2e-5\n" : "");
    all.push_back(scene);
  }
  return all;
}

/// Without stops: disturbances do not grow.
std::vector<Scene> linear_scenes() {
  return {
      single("linear_forced", 2.0, 2e4, 0.0, {}, {{0, 30.0, 37.0}}, 0.0, 0.0, 5.0),
      single("linear_damped", 2.0, 2e4, 8.0, {}, {{0, 30.0, 95.0, 0.4}}, 1e-3, 0.0, 5.0),
      single("linear_resonance", 2.0, 2e4, 0.0, {}, {{0, 30.0, 100.0}}, 0.0, 0.0, 2.0),
      single("linear_two_loads", 2.0, 2e4, 1.0, {}, {{0, 30.0, 37.0}, {0, 20.0, 251.0}}, 0.0, 0.1, 2.0),
      {"linear_two_masses", {1.0, 0.5}, {{0, -1, 1e4, 0.0}, {0, 1, 5e3, 0.0}}, {}, {}, {1e-3, 0.0}, {0.0, 0.2}, 5.0},
      {"linear_two_masses_forced",
       {1.0, 1.0},
       {{0, -1, 1e4, 4.0}, {0, 1, 1e4, 2.0}},
       {},
       {{1, 50.0, 70.0}},
       {},
       {},
       5.0},
  };
}

/// x'' + 0.1 x' + x + stops = F cos(W t): periodic motion, stable according to its Floquet multipliers.
std::vector<Scene> periodic_scenes() {
  const auto bilinear = [](const std::string& name, double k, double omega) {
    return single(name, 1.0, 1.0, 0.1, {{0, -1, 0.0, k, 1}}, {{0, 1.0, omega}}, -0.86, 0.1, 100.0);
  };
  const auto with_gap = [](const std::string& name, int sides, double omega, double x0, double v0) {
    return single(name, 1.0, 1.0, 0.1, {{0, -1, 1.0, 8.0, sides}}, {{0, 0.3, omega}}, x0, v0, 100.0);
  };
  return {
      bilinear("bilinear_period_1", 8.0, 2.0),       // |multipliers| 0.855
      bilinear("bilinear_period_1_slow", 8.0, 1.5),  //
      bilinear("bilinear_period_2", 8.0, 2.4),       // 0.770 over two periods
      bilinear("bilinear_weak", 3.0, 2.0),           // below the period doubling at 2.2345
      bilinear("bilinear_weak_fast", 3.0, 3.6),      // above the period doubling at 3.4584
      with_gap("gap_one_stop", 1, 1.0, 1.012632, 0.797568),
      with_gap("gap_one_stop_upper", 1, 1.2, 0.590392, 2.020975),
      with_gap("gap_two_stops", 0, 1.0, 1.008032, 0.517477),
      with_gap("gap_two_stops_upper", 0, 1.2, 1.021683, 0.897054),
      with_gap("gap_lower_branch", 0, 1.5, 0.0, 0.0),  // the linear motion with the smaller amplitude, one of two
      {"two_masses_rattling",
       {1.0, 1.0},
       {{0, -1, 1e4, 20.0}, {1, -1, 4e4, 20.0}},
       {{0, 1, 5e-4, 1e5, 1}},
       {{0, 30.0, 60.0}},
       {},
       {},
       1.5},
  };
}

/// A stop that the motion barely reaches.
std::vector<Scene> grazing_scenes() {
  const auto forced = [](const std::string& name, double part, int sides) {
    // Steady amplitude F/sqrt((k - m W^2)^2 + (c W)^2)
    const double k = 1e4, c = 40.0, omega = 60.0, force = 20.0;
    const double amplitude = force / std::hypot(k - omega * omega, c * omega);
    Scene scene = single(name, 1.0, k, c, {{0, -1, part * amplitude, 1e6, sides}}, {{0, force, omega}}, amplitude * 0.9,
                         0.0, 2.0);
    return scene;
  };
  const auto thrown = [](const std::string& name, double speed) {
    return single(name, 1.0, 1e4, 0.0, {{0, -1, 1e-3, 1e6}}, {}, 0.0, speed, 2.0);
  };
  return {forced("grazing_forced_just", 1.0 - 1e-6, 1),      forced("grazing_forced", 0.999, 1),
          forced("grazing_forced_deeper", 0.97, 0),          forced("grazing_forced_not", 1.0 + 1e-6, 1),
          thrown("grazing_thrown_just", 0.1 * (1.0 + 1e-9)), thrown("grazing_thrown", 0.1 * 1.0001),
          thrown("grazing_thrown_not", 0.1 * (1.0 - 1e-9))};
}

/// The same oscillator at amplitudes (N) and frequencies (rad/s), some of them chaotic; 80-bit arithmetic
/// from two starts determines which.
Scene driven(double amplitude, double omega, double end, Growth growth, int sides = 0) {
  Scene scene = single("driven_" + std::to_string(std::lround(amplitude)) + "_" + std::to_string(std::lround(omega)) +
                           (sides == 0 ? "" : "_one_side") + "_" + std::to_string(std::lround(10.0 * end)),
                       2.5, 4e4, 3.0, {{0, -1, 1e-3, 1e6, sides}}, {{0, amplitude, omega}}, 0.0, 0.0, end);
  scene.growth = growth;
  return scene;
}

/// At 60 N and 80 rad/s small differences grow like e^(9 t) for a while; then the motion becomes regular.
std::vector<Scene> driven_scenes() {
  const auto chaos = Growth::exponential, order = Growth::none;
  return {driven(60, 80, 1, chaos),    driven(60, 80, 2, chaos),   driven(60, 80, 4, chaos),
          driven(100, 60, 1.5, chaos), driven(100, 110, 1, chaos), driven(150, 80, 1, chaos),
          driven(80, 60, 3, chaos),    driven(40, 60, 2, order),   driven(80, 70, 2, order),
          driven(40, 110, 2, order),   driven(80, 110, 2, order),  driven(60, 80, 2, order, 1),
          driven(150, 80, 2, order, 1)};
}

std::vector<Scene> all_scenes() {
  std::vector<Scene> all;
  for (auto* some : {&free_scenes, &linear_scenes, &periodic_scenes, &grazing_scenes, &driven_scenes})
    for (Scene& scene : (*some)()) all.push_back(std::move(scene));
  return all;
}

class Trust : public testing::TestWithParam<Scene> {};

TEST_P(Trust, BoundsTheErrorHoldsThePeaksAndKnowsChaos) {
  const Scene& scene = GetParam();
  scene::Scene session = read_scene(scene.toml());
  const std::vector<double> times = app::trust::compared_times(session);
  const app::trust::FollowedRun run = app::trust::follow(session, 0.0, std::numeric_limits<double>::infinity(), {});
  const record::Trust trust = app::find_trust(session);
  const ExtendedMotion truth = integrate_extended(scene.extended(), times);

  double peak = 0.0, horizon_error = 0.0, end_error = 0.0;
  for (std::size_t dof = 0; dof < scene.mass.size(); ++dof)
    for (std::size_t i = 0; i < times.size(); ++i) {
      const double error = static_cast<double>(std::abs(run.histories.values[dof][i] - truth.rows[dof][i]));
      peak = std::max(peak, std::abs(run.histories.values[dof][i]));
      end_error = std::max(end_error, error);
      if (times[i] <= trust.horizon) horizon_error = std::max(horizon_error, error);
    }
  RecordProperty("error", std::to_string(end_error / peak));
  if (std::getenv("BUTEE_TRUST_TABLE") != nullptr) {
    const ExtendedGrowth grown = grow_extended(scene.extended(), scene.end_time);
    std::printf("%-28s error %.1e bound %.1e (%s) rate %.3g growth %.3g; true rate %.3g growth %.3g\n",
                scene.name.c_str(), end_error / peak, trust.end_bound, trust.other.c_str(), trust.growth_rate,
                trust.amplification, grown.rate, grown.factor);
  }
  EXPECT_LE(horizon_error, trust.bound * peak);
  EXPECT_LE(end_error, trust.end_bound * peak);

  const auto expect_holds = [&](const std::string& name, double value) {
    for (const record::Trust::Statistic& s : trust.statistics)
      if (s.name == name) {
        EXPECT_LE(s.least, value) << name;
        EXPECT_GE(s.greatest, value) << name;
        return;
      }
    ADD_FAILURE() << "there is no " << name;
  };
  for (std::size_t dof = 0; dof < scene.mass.size(); ++dof) {
    const std::string column = "m" + std::to_string(dof) + ".u";
    expect_holds("peak of " + column, truth.peak[dof]);
    long double squares = 0.0L;
    for (const long double u : truth.rows[dof]) squares += u * u;
    expect_holds("rms of " + column, static_cast<double>(std::sqrt(squares / static_cast<long double>(times.size()))));
  }
  if (!scene.stops.empty()) expect_holds("largest contact force", truth.contact_force);

  EXPECT_EQ(trust.chaotic, scene.growth == Growth::exponential) << trust.growth_rate;
  if (scene.growth == Growth::exponential) {
    const double rate = grow_extended(scene.extended(), trust.growth_until).rate;
    EXPECT_NEAR(trust.growth_rate, rate, 0.3 * rate);  // two ways to fit the slope of a scattered growth
  } else if (scene.mass.size() == 1) {
    double factor = 1.0;
    for (const Disturbed disturbed : {Disturbed::velocity, Disturbed::displacement})
      factor = std::max(factor, grow_extended(scene.extended(), scene.end_time, disturbed).factor);
    // Growth is sampled at a thousand instants. If a stop is reached by only 1e-9 m, it also depends on the
    // size of the disturbance.
    EXPECT_GE(trust.amplification, 0.85 * factor);
    EXPECT_LE(trust.amplification, 1.5 * factor);
  }
}

/// Behind the horizon the motion is unknown unless a bound of its error is known there.
TEST(TrustText, ForetellsNothingWhereNoBoundIsKnown) {
  record::Trust trust;
  EXPECT_NE(record::describe(trust).find("nothing is judged"), std::string::npos);
  trust.statistics = {{"largest |m.u|", 1.0, 0.9, 1.1}};
  trust.chaotic = true;
  trust.accuracy = 1e-3;
  trust.horizon = 0.27;
  trust.end = 1.0;
  const auto says = [&trust](double bound) {
    trust.end_bound = bound;
    return record::describe(trust).find("cannot be predicted") != std::string::npos;
  };
  EXPECT_FALSE(says(0.017));
  EXPECT_TRUE(says(3.0));
  EXPECT_TRUE(says(std::numeric_limits<double>::infinity()));
}

/// A method that ends its steps at the rows of the results is judged in a run with these rows.
TEST(TrustRuns, AreTheRunOfTheResults) {
  const std::string toml = driven(40, 60, 2, Growth::none).toml();
  for (const char* method : {"extrapolation8", "rodas4"})
    for (const char* interval : {"0.01", "1e-3"}) {
      const std::vector<std::string> changes = {std::string("integrator.type=") + method, "integrator.tolerance=1e-3",
                                                std::string("output.interval=") + interval};
      scene::Scene session = read_scene(toml, changes);
      const auto run = app::trust::follow(session, 0.0, std::numeric_limits<double>::infinity(), {});
      SceneRun results(toml, changes);
      std::vector<double> rows;
      for (int i = 0; i * std::stod(interval) < 2.0 - 1e-9; ++i) rows.push_back(i * std::stod(interval));
      Sampler sampler(results.dof("m0"), rows);
      results.simulation().add(sampler);
      ASSERT_TRUE(results.run().completed);
      const auto& times = run.histories.times;
      for (std::size_t i = 0; i < rows.size(); ++i) {
        const auto at = std::lower_bound(times.begin(), times.end(), rows[i] - 1e-9) - times.begin();
        ASSERT_NEAR(run.histories.values[0][static_cast<std::size_t>(at)], sampler.x[i], 1e-12) << method << rows[i];
      }
    }
}

/// Methods without error control restart with other steps at the instants between which disturbances are followed. That
/// is no growth of the motion, even at 75 steps a period.
TEST(TrustOfUncontrolledSteps, KnowsRegularMotion) {
  const Scene regular = driven(40, 60, 2, Growth::none), wild = driven(60, 80, 2, Growth::exponential);
  for (const std::string method : {"newmark", "newmark_modified", "rk4", "generalized_alpha"}) {
    scene::Scene session = read_scene(regular.toml(), {"integrator.type=" + method, "integrator.time_step=1.4e-3"});
    const record::Trust trust = app::find_trust(session);
    EXPECT_FALSE(trust.chaotic) << method << ", rate " << trust.growth_rate;
    EXPECT_LT(trust.amplification, 100.0) << method;
  }
  scene::Scene session = read_scene(wild.toml(), {"integrator.type=newmark", "integrator.time_step=1e-3"});
  EXPECT_TRUE(app::find_trust(session).chaotic);
}

/// On a base that moves away the motion relative to it is the difference of long ways, whose errors are as large as it
/// is. What a probe records is judged, in its own frame.
TEST(TrustBesideAMovingBase, IsThatOfTheFrameOfTheProbe) {
  const auto bound_of = [](const std::string& quantity) {
    scene::Scene session = read_scene(R"(
schema = 1
[[element]]
type = "mass"
name = "m"
mass = 2.0
[[element]]
type = "spring"
node = "m"
stiffness = 2000.0
damping = 4.0
[base]
acceleration = { direction = [0, 1, 0], type = "table", times = [0.0, 0.1, 0.2, 10.0], values = [0.0, 0.5, -0.5, 0.0] }
initial_velocity = 10.0
[[contact]]
type = "stop"
nodes = "m"
gap = 1000.0
law = "linear"
stiffness = 1e4
frame = "space"
[integrator]
type = "rodas4"
tolerance = 1e-3
end_time = 5.0
[output]
interval = 0.01
[[output.probe]]
node = "m"
quantities = [")" + quantity + "\"]\n",
                                      {});
    return app::find_trust(session).end_bound;
  };
  EXPECT_GT(bound_of("u"), 0.1);
  EXPECT_LT(bound_of("u_abs"), 1e-3);
}

/// A rotation is the same relative to the base and in space, also where a section force is asked for beside it.
TEST(TrustBesideAMovingBase, NamesARotationOnce) {
  scene::Scene session = read_scene(R"(
schema = 1
[material.s]
young_modulus = 2e11
density = 7800.0
[section.r]
shape = "rectangle"
width = 0.03
height = 0.02
[[element]]
type = "beam"
name = "b"
material = "s"
section = "r"
length = 1.2
elements = 2
[[support]]
nodes = "b:first"
fix = ["u", "theta"]
[base]
acceleration = { direction = [0, 1, 0], type = "harmonic", amplitude = 12.0, angular_frequency = 55.0 }
[[contact]]
type = "stop"
nodes = "b:last"
gap = 0.002
stiffness = 5e4
frame = "space"
[integrator]
end_time = 0.02
[[output.probe]]
label = "n"
node = "b:last"
quantities = ["theta", "M"]
)",
                                    {});
  const record::Trust trust = app::find_trust(session);
  std::map<std::string, int> names;
  for (const auto& statistic : trust.statistics) ++names[statistic.name];
  EXPECT_FALSE(names.empty());
  for (const auto& [name, count] : names) EXPECT_EQ(count, 1) << name;
}

INSTANTIATE_TEST_SUITE_P(KnownScenes, Trust, testing::ValuesIn(all_scenes()),
                         [](const auto& one) { return one.param.name; });

}  // namespace
}  // namespace butee::test::trust_test
