#include <cmath>
#include <numbers>
#include <sstream>

#include <Eigen/LU>
#include <butee/core/error.hpp>
#include <butee/model/smooth_motion.hpp>
#include <butee/record/history.hpp>
#include <gtest/gtest.h>

#include "pinned_bar.hpp"
#include "support/scene_run.hpp"

namespace butee::test::base_test {
namespace {

using std::numbers::pi;

/// Values of probes at given times of a run, evaluated as in the program.
class Rows final : public time::Observer {
 public:
  Rows(dynamics::Dynamics& dynamics, const model::NodeTable& nodes, const std::string& node,
       std::vector<model::Quantity> quantities, std::vector<double> times)
      : probes_({{"p", nodes.select(node).nodes.front(), std::move(quantities), ""}}, dynamics),
        times_(std::move(times)) {}
  void start(const time::State& state) override {
    if (times_.front() == state.t) {
      rows.emplace_back(probes_.columns().size());
      probes_.evaluate(state, rows.back());
    }
  }
  void step(const time::AcceptedStep& step) override {
    while (rows.size() < times_.size() && times_[rows.size()] <= step.to.t) {
      std::vector<double> row(probes_.columns().size());
      probes_.evaluate(step, times_[rows.size()], row);
      rows.push_back(row);
    }
  }
  double next_instant(double t) const override {
    for (const double instant : times_)
      if (instant > t) return instant;
    return 1e300;
  }

  std::vector<std::vector<double>> rows;

 private:
  record::Probes probes_;
  std::vector<double> times_;
};

std::string text(double value) {
  std::ostringstream out;
  out.precision(17);
  out << value;
  return out.str();
}

constexpr double kOmega = 20.0 * pi;
const std::vector<double> kTimes = {0.05, 0.156, 0.25, 0.4, 0.5, 0.8, 0.9, 1.0};
const std::vector<model::Quantity> kAbsolute = {model::Quantity::u_abs, model::Quantity::u};

std::string oscillator(const std::string& name, const std::string& foot) {
  const std::string damping = text(2.0 * 0.07 * std::sqrt(98696.0 * 25.0));
  return "[[element]]\ntype = \"mass\"\nname = \"" + name + "\"\nmass = 25.0\n[[element]]\ntype = \"spring\"\n" +
         (foot.empty() ? "node = \"" + name + "\"\n" : "nodes = [\"" + name + "\", \"" + foot + "\"]\n") +
         "stiffness = 98696.0\ndamping = " + damping + "\n";
}

std::string sine(double sign) {
  return "{ direction = [0, " + std::string(sign > 0 ? "1" : "-1") +
         ", 0], type = \"harmonic\", amplitude = 1.0, angular_frequency = " + text(kOmega) +
         ", phase = " + text(-pi / 2) + " }";
}

std::string wall(const std::string& keys, double gap, double stiffness) {
  return "[[contact]]\ntype = \"stop\"\n" + keys + "\ngap = " + text(gap) + "\nstiffness = " + text(stiffness) + "\n";
}

const std::string kExact = "[integrator]\ntype = \"exact\"\nend_time = 1.0\n";

/// SDND102: an oscillator on a base with acceleration sin(20 pi t) and displacement -sin/Om^2, initially at
/// rest relative to the base, strikes a wall fixed in space. Reference: absolute displacements from an
/// integration that locates events exactly.
TEST(Pounding, MeetsAWallFixedInSpace) {
  SceneRun run("schema = 1\n" + oscillator("m", "") +
               wall("nodes = \"m\"\nsides = \"positive\"\nframe = \"space\"", 5e-4, 5.76e7) +
               "[base]\nacceleration = " + sine(1) + "\ninitial_velocity = " + text(-1.0 / kOmega) + "\n" + kExact);
  Rows rows(run.dynamics(), run.model().nodes, "m", kAbsolute, kTimes);
  run.simulation().add(rows);
  const auto recorder = [&](double interval) {
    model::OutputRequest request;
    request.interval = interval;
    request.probes = {{"m", run.model().nodes.select("m").nodes.front(), kAbsolute, ""}};
    return std::make_unique<record::HistoryRecorder>(request, 1.0, run.dynamics(), nullptr);
  };
  const auto few = recorder(0.5), many = recorder(1e-5);
  run.simulation().add(*few);
  run.simulation().add(*many);
  ASSERT_TRUE(run.run().completed);
  // Peaks include motion between rows: 1e5 rows find them to some 1e-9.
  for (const char* column : {"m.u_abs", "m.u"})
    EXPECT_NEAR(few->peaks().at(column), many->peaks().at(column), 1e-6 * many->peaks().at(column)) << column;
  const double wanted[] = {-3.5800406896e-4, -1.2211672315e-4, -1.8870187799e-4, -1.8984007402e-4,
                           -7.0214753128e-5, -1.1018592667e-4, -1.1907225628e-4, -1.0855912659e-4};
  for (std::size_t i = 0; i < kTimes.size(); ++i) {
    EXPECT_NEAR(rows.rows[i][0], wanted[i], 1e-9) << kTimes[i];
    EXPECT_NEAR(rows.rows[i][1], wanted[i] + std::sin(kOmega * kTimes[i]) / (kOmega * kOmega), 1e-9) << kTimes[i];
  }
}

/// Two mirrored oscillators on two bases strike each other as one strikes a wall: equal results to rounding.
TEST(Pounding, OfTwinsIsThatOfOneAtAWall) {
  const auto supports = [](const std::string& nodes) {
    return "[[support]]\nnodes = [" + nodes + "]\nfix = [\"u\"]\n";
  };
  const auto foot = [](const std::string& name) {
    return "[[element]]\ntype = \"mass\"\nname = \"" + name + "\"\nmass = 1.0\n";
  };
  const auto base = [](const std::string& node, double sign) {
    return "[[base]]\nnodes = \"" + node + "\"\nacceleration = " + sine(sign) +
           "\ninitial_velocity = " + text(-1.0 / kOmega) + "\n";
  };
  const auto start = [](const std::string& node, double v) {
    return "{ nodes = \"" + node + "\", value = " + text(v) + " }";
  };
  SceneRun one("schema = 1\n" + foot("f") + oscillator("m", "f") + supports("\"f\"") +
               wall("nodes = \"m\"\nsides = \"positive\"", 5e-4, 5.76e7) + base("f", 1) + "[initial]\nvelocity = [" +
               start("m", -1.0 / kOmega) + "]\n" + kExact);
  SceneRun two("schema = 1\n" + foot("f") + foot("g") + oscillator("m", "f") + oscillator("n", "g") +
               supports("\"f\", \"g\"") + wall("between = [\"m\", \"n\"]\nsides = \"positive\"", 1e-3, 2.88e7) +
               base("f", 1) + base("g", -1) + "[initial]\nvelocity = [" + start("m", -1.0 / kOmega) + ", " +
               start("n", 1.0 / kOmega) + "]\n" + kExact);
  Rows of_one(one.dynamics(), one.model().nodes, "m", kAbsolute, kTimes);
  Rows of_two(two.dynamics(), two.model().nodes, "m", kAbsolute, kTimes);
  Rows of_foot(two.dynamics(), two.model().nodes, "g", kAbsolute, kTimes);
  one.simulation().add(of_one);
  two.simulation().add(of_two);
  two.simulation().add(of_foot);
  ASSERT_TRUE(one.run().completed);
  ASSERT_TRUE(two.run().completed);
  for (std::size_t i = 0; i < kTimes.size(); ++i) {
    // A hundred contact instants, each located to the rounding of displacements of 5e-4 m.
    EXPECT_NEAR(of_two.rows[i][0], of_one.rows[i][0], 1e-13) << kTimes[i];
    EXPECT_NEAR(of_foot.rows[i][0], std::sin(kOmega * kTimes[i]) / (kOmega * kOmega), 1e-15);
  }
  EXPECT_NEAR(of_one.rows[0][0], -3.5800406896e-4, 1e-9);
}

std::string moved_bar(int elements, double frequency) {
  return pinned_bar(elements) +
         "[[base]]\nnodes = \"bar:first\"\ndisplacement = { direction = [0, 1, 0], type = \"harmonic\", amplitude = "
         "1.0, angular_frequency = " +
         text(2 * pi * frequency) + " }\n[integrator]\ntype = \"newmark\"\ntime_step = 1e-3\nend_time = 1e-2\n";
}

/// Steady-state midspan displacement of a pinned bar with a moving left support: K_dyn x = F at one
/// frequency, with the loads of the scene.
double steady_midspan(int elements, double frequency) {
  SceneRun run(moved_bar(elements, frequency));
  const double omega = 2 * pi * frequency;
  Vector force(run.system().size());
  run.dynamics().external_force(0.0, force);
  const Eigen::MatrixXd dynamic =
      Eigen::MatrixXd(run.system().stiffness) - omega * omega * Eigen::MatrixXd(run.system().mass);
  return Vector(dynamic.partialPivLu().solve(force))[run.dof("bar:middle")];
}

TEST(MovedSupport, MovesTheMidspanAsTheClosedFormSays) {
  EXPECT_NEAR(steady_midspan(10, 3.0), .86372866, 5e-9);
  EXPECT_NEAR(steady_midspan(20, 3.0), .86373130, 5e-9);
  // Rounding of a dense solution; with fourth order the mesh error of 80 elements is 1e-9.
  constexpr double kSolved = 1e-8;
  EXPECT_NEAR(steady_midspan(80, 3.0), .8637314800, kSolved);
  EXPECT_NEAR(steady_midspan(80, 8.0), -.5436484523, kSolved);
  EXPECT_NEAR(steady_midspan(80, 15.0), -.2404363150, kSolved);
  const double coarse = steady_midspan(6, 8.0) + .5436484523, fine = steady_midspan(12, 8.0) + .5436484523;
  EXPECT_NEAR(std::log2(std::abs(coarse / fine)), 4.0, 0.3);
}

/// The same motion of all supports, given by acceleration, by displacement, or for each support; seen from
/// the base or from space.
TEST(MovedBase, IsTheSameHoweverItIsSaid) {
  const std::string bar = pinned_bar(8);
  const double omega = 30.0;
  const std::string cosine = "direction = [0, 1, 0], type = \"harmonic\", angular_frequency = " + text(omega) + " }\n";
  const std::string displacement = "{ amplitude = 1e-3, " + cosine,
                    acceleration = "{ amplitude = " + text(-1e-3 * omega * omega) + ", " + cosine;
  const std::string rest = "[damping]\nstiffness_proportional = 1e-4\n[integrator]\ntype = \"exact\"\nend_time = 0.4\n";
  const std::vector<double> times = {0.1, 0.2, 0.3, 0.4};
  const auto motion = [&](const std::string& scene) {
    SceneRun run(bar + scene + rest);
    Rows rows(run.dynamics(), run.model().nodes, "bar:middle",
              {model::Quantity::u_abs, model::Quantity::v_abs, model::Quantity::a_abs}, times);
    run.simulation().add(rows);
    EXPECT_TRUE(run.run().completed);
    return rows.rows;
  };
  const auto expected = motion("[base]\ndisplacement = " + displacement);
  const std::string start = "[initial]\ndisplacement = [{ nodes = \"bar:1..7\", value = 1e-3 }]\n";
  const auto supports =
      motion("[[base]]\nnodes = [\"bar:first\", \"bar:last\"]\ndisplacement = " + displacement + start);
  const auto in_space =
      motion("[base]\ndisplacement = " + displacement +
             "[[contact]]\ntype = \"stop\"\nnodes = \"bar:middle\"\ngap = 1.0\nstiffness = 1.0\nframe "
             "= \"space\"\n");
  const auto accelerated = motion("[base]\nacceleration = " + acceleration);
  EXPECT_GT(std::abs(expected[3][0]), 1e-4);
  for (std::size_t i = 0; i < times.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      // Modal sums of up to 14 modes; in accelerations the highest modes dominate the error.
      const double tolerance = 1e-11 * std::pow(100.0, k);
      EXPECT_NEAR(supports[i][k], expected[i][k], tolerance) << i << " " << k;
      EXPECT_NEAR(in_space[i][k], expected[i][k], tolerance) << i << " " << k;
      // An acceleration does not determine the initial displacement of the base; it starts at 0.
      const double shift = k == 0 ? 1e-3 : 0.0;
      EXPECT_NEAR(accelerated[i][k] + shift, expected[i][k], tolerance) << i << " " << k;
    }
}

/// At rest relative to a base that moves at the start: its acceleration acts, its dashpots do not.
TEST(MovedBase, StartsFromTheSameStaticPositionInEitherFrame) {
  const auto motion = [](const std::string& frame) {
    SceneRun run(
        "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 2.0\n[[element]]\ntype = \"spring\"\nnode = "
        "\"m\"\nstiffness = 2000.0\ndamping = 20.0\n[[contact]]\ntype = \"stop\"\nnodes = \"m\"\ngap = 1.0\nstiffness "
        "= "
        "8e4\nframe = \"" +
        frame +
        "\"\n[gravity]\nacceleration = [0, -9.81, 0]\nstatic = true\n[base]\ndisplacement = { direction = [0, 1, 0], "
        "type = \"harmonic\", amplitude = 0.01, angular_frequency = 28.0, phase = 0.7 }\n[integrator]\ntype = "
        "\"exact\"\nend_time = 0.2\n");
    Rows rows(run.dynamics(), run.model().nodes, "m", {model::Quantity::u, model::Quantity::v, model::Quantity::a},
              {0.0, 0.1, 0.2});
    run.simulation().add(rows);
    EXPECT_TRUE(run.run().completed);
    return rows.rows;
  };
  const auto base = motion("base"), space = motion("space");
  const double acceleration = -0.01 * 28.0 * 28.0 * std::cos(0.7);
  EXPECT_NEAR(base[0][0], -2.0 * (9.81 + acceleration) / 2000.0, 1e-12);
  for (const auto& rows : {base, space}) {
    EXPECT_NEAR(rows[0][1], 0.0, 1e-15);
    EXPECT_NEAR(rows[0][2], 0.0, 1e-9);
  }
  for (std::size_t i = 0; i < base.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(space[i][k], base[i][k], 1e-12 * std::pow(100.0, k)) << i << k;
}

/// A spline through samples of a smooth motion: accelerations are accurate to h^2.
TEST(MovedBase, GoesSmoothlyThroughATable) {
  std::vector<double> times, values;
  for (int i = 0; i <= 200; ++i) {
    times.push_back(0.01 * i);
    values.push_back(std::pow(std::sin(0.5 * pi * times.back()), 4));  // at rest at both ends
  }
  const auto d = model::PiecewisePolynomial::spline(times, values);
  const auto a = d.derivative().derivative();
  for (const double t : {0.303, 0.777, 1.4142}) {
    const double s = std::sin(0.5 * pi * t), c = std::cos(0.5 * pi * t);
    EXPECT_NEAR(d.value(t), std::pow(s, 4), 1e-7);
    EXPECT_NEAR(a.value(t), pi * pi / 4 * (12 * s * s * c * c - 4 * std::pow(s, 4)), 3e-3);
  }
  EXPECT_EQ(d.value(3.0), values.back());
  EXPECT_EQ(a.value(3.0), 0.0);
  std::array<double, 3> series{};
  a.integral(0.5).taylor(0.777, 1.0, series);
  EXPECT_NEAR(series[1], a.value(0.777), 1e-12);
  EXPECT_EQ(a.integral(0.5).value(0.0), 0.5);
}

struct Mistake {
  std::string name, scene, says;
};

class BadBase : public testing::TestWithParam<Mistake> {};

TEST_P(BadBase, IsSaidWithItsRemedy) {
  try {
    read_scene(GetParam().scene);
    FAIL() << "was read";
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find(GetParam().says), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

const std::string kMass = "schema = 1\n" + oscillator("m", "") + kExact;
const std::string kMotion =
    "{ direction = [0, 1, 0], type = \"harmonic\", amplitude = 1.0, angular_frequency = 3.0 }\n";

INSTANTIATE_TEST_SUITE_P(
    scenes, BadBase,
    testing::Values(
        Mistake{"neither", kMass + "[base]\n", "give acceleration or displacement"},
        Mistake{"both", kMass + "[base]\nacceleration = " + kMotion + "displacement = " + kMotion, "has both"},
        Mistake{"velocity", kMass + "[base]\ninitial_velocity = 1.0\ndisplacement = " + kMotion,
                "base.initial_velocity = 1.0: belongs to acceleration"},
        Mistake{"ramp",
                kMass + "[base]\ndisplacement = { direction = [0, 1, 0], type = \"ramp\", to = 1.0, end = 2.0 }\n",
                "a ramp of displacement has jumps of velocity; give a table"},
        Mistake{"late_table",
                kMass +
                    "[base]\ndisplacement = { direction = [0, 1, 0], type = \"table\", times = [1, 2], values = [0, "
                    "1] }\n",
                "must begin at t = 0 or before"},
        Mistake{"too_slow",
                kMass + "[base]\nacceleration = { direction = [0, 1, 0], type = \"harmonic\", amplitude = 1.0, "
                        "angular_frequency = 1e-8 }\n",
                "too little for its double integral in double precision; give a constant or a ramp"},
        Mistake{"no_direction", kMass + "[base]\nacceleration = { type = \"constant\", value = 1.0 }\n",
                "base.acceleration.direction: missing"},
        Mistake{"along_nothing",
                kMass + "[base]\nacceleration = { direction = [0, 0, 1], type = \"constant\", value = 1.0 }\n",
                "acts along no displacement of the scene"},
        Mistake{"free_node", kMass + "[[base]]\nnodes = \"m\"\nacceleration = " + kMotion,
                "no [[support]] holds m along the direction"},
        Mistake{"frame_without_base", kMass + wall("nodes = \"m\"\nframe = \"space\"", 1.0, 1.0),
                "give [base], or remove frame"},
        Mistake{"two_frames",
                kMass + wall("nodes = \"m\"\nframe = \"space\"", 1.0, 1.0) + wall("nodes = \"m\"", 2.0, 1.0) +
                    "[base]\nacceleration = " + kMotion,
                "contact[1].frame: differs from that of another"},
        Mistake{"modal_in_space",
                kMass + wall("nodes = \"m\"\nframe = \"space\"", 1.0, 1.0) +
                    "[damping]\nmodal = 0.1\n[base]\nacceleration = " + kMotion,
                "give mass_proportional and stiffness_proportional"},
        Mistake{"absolute_without_base",
                kMass + "[[output.probe]]\nlabel = \"m\"\nnode = \"m\"\nquantities = [\"u_abs\"]\n",
                "there is no u_abs: the base does not move"}),
    [](const auto& one) { return one.param.name; });

/// The acceleration of the base jumps where the curve of a displacement table ends; a step that ends there has the
/// limit from the left. With an open stop, too, which the collocation of `exponential` watches.
TEST(BaseTable, EndsWithAJumpOfTheAcceleration) {
  const std::string scene =
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"a\"\nmass = 1.0\n[[element]]\ntype = \"spring\"\nnode = "
      "\"a\"\n"
      "stiffness = 2500.0\ndamping = 2.0\n[base]\ndisplacement = { direction = [0, 1, 0], type = \"table\", times = "
      "[0.0, "
      "0.05, 0.10, 0.13], values = [0.0, 0.0, 1.0e-3, 0.0] }\n[integrator]\ntype = \"exact\"\nend_time = 0.3\n";
  const std::string stop =
      "[[contact]]\ntype = \"stop\"\nnodes = \"a\"\ngap = 1.0\nstiffness = 1e5\ndamping = { type = \"hunt_crossley\", "
      "factor = "
      "0.5 }\n";
  SceneRun exact(scene);
  ASSERT_TRUE(exact.run().completed);
  const time::State& right = exact.simulation().state();
  for (const std::string& contact : {std::string(), stop}) {
    SceneRun other(scene + contact, {"integrator.type=exponential", "integrator.tolerance=1e-6"});
    ASSERT_TRUE(other.run().completed);
    EXPECT_NEAR(other.simulation().state().x[0], right.x[0], 1e-12);
    EXPECT_NEAR(other.simulation().state().v[0], right.v[0], 1e-10);
  }
}

}  // namespace
}  // namespace butee::test::base_test
