// The method in closed form against exact, which expands in series and finds changes as roots of polynomials, and
// against closed forms. Random chains have all kinds of stops, damping and loads that it takes.
#include "integrators/piecewise.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <butee/core/error.hpp>
#include <butee/core/text.hpp>
#include <gtest/gtest.h>

#include "support/scene_run.hpp"

namespace butee::test::piecewise_test {
namespace {

class RandomChain {
 public:
  explicit RandomChain(unsigned seed, bool dissipates = false) : random_(seed), dissipates_(dissipates) {
    const int n = 1 + static_cast<int>(seed % 4);
    scene_ << "schema = 1\n";
    scene_.precision(17);
    const bool is_free = n > 1 && chance(0.15);
    for (int i = 0; i < n; ++i)
      scene_ << "[[element]]\ntype = \"mass\"\nname = \"m" << i << "\"\nmass = " << log_uniform(0.3, 3.0) << "\n";
    const bool has_dashpots = chance(0.3);
    if (!is_free) spring("node = \"m0\"", has_dashpots && chance(0.7));
    for (int i = 1; i < n; ++i)
      spring("nodes = [\"m" + std::to_string(i - 1) + "\", \"m" + std::to_string(i) + "\"]",
             has_dashpots && chance(0.7));
    stop("nodes = \"m" + std::to_string(n - 1) + "\"");
    for (int i = 1; i < n; ++i)
      if (chance(0.5)) stop("between = [\"m" + std::to_string(i - 1) + "\", \"m" + std::to_string(i) + "\"]");
    load(n - 1);
    if (chance(0.5)) load(0);
    const double damping = uniform();
    if (damping < 0.3)
      scene_ << "[damping]\nmass_proportional = " << log_uniform(0.01, 3.0) << "\n";
    else if (damping < 0.5)
      scene_ << "[damping]\nstiffness_proportional = " << log_uniform(1e-4, 1e-1) << "\n";
    else if (damping < 0.6 && !is_free)
      scene_ << "[damping]\nmodal = " << log_uniform(0.01, 0.3) << "\n";
    scene_ << "[initial]\nvelocity = [{ nodes = \"m0\", value = ";
    velocity_ = 2.0 * uniform() - 1.0;
  }

  std::string scene(double perturbation = 0.0) const {
    std::ostringstream all;
    all.precision(17);
    all << scene_.str() << velocity_ + perturbation << " }]\n[integrator]\nend_time = 12.0\n";
    return all.str();
  }

 private:
  double uniform() { return std::uniform_real_distribution<double>(0.0, 1.0)(random_); }
  bool chance(double p) { return uniform() < p; }
  double log_uniform(double from, double to) { return from * std::pow(to / from, uniform()); }

  void spring(const std::string& ends, bool has_dashpot) {
    scene_ << "[[element]]\ntype = \"spring\"\n" << ends << "\nstiffness = " << log_uniform(5.0, 50.0) << "\n";
    if (has_dashpot) scene_ << "damping = " << log_uniform(0.01, 10.0) << "\n";
  }
  void stop(const std::string& ends) {
    const double sides = uniform();
    scene_ << "[[contact]]\ntype = \"stop\"\n"
           << ends << "\ngap = " << (chance(0.1) && !dissipates_ ? 0.0 : 0.01 + 0.2 * uniform()) << "\nsides = \""
           << (sides < 0.4   ? "both"
               : sides < 0.7 ? "positive"
                             : "negative")
           << "\"\nlaw = \"linear\"\nstiffness = " << log_uniform(10.0, 1e5) << "\n";
    if (dissipates_)
      scene_ << "damping = { type = \"kelvin_voigt\", coefficient = " << log_uniform(0.1, 30.0)
             << (chance(0.3) ? ", pull = true" : "") << " }\n";
  }
  void load(int mass) {
    scene_ << "[[load]]\nnode = \"m" << mass << "\"\n";
    const double type = uniform();
    if (type < 0.6)
      scene_ << "type = \"harmonic\"\namplitude = " << log_uniform(1.0, 20.0)
             << "\nangular_frequency = " << log_uniform(0.5, 30.0) << "\nphase = " << 6.0 * uniform() << "\n";
    else if (type < 0.7)
      scene_ << "type = \"constant\"\nvalue = " << log_uniform(0.1, 5.0) << "\n";
    else if (type < 0.85)
      scene_ << "type = \"ramp\"\nto = " << log_uniform(1.0, 10.0) << "\nstart = 0.5\nend = " << 1.0 + 5.0 * uniform()
             << "\n";
    else
      scene_ << "type = \"table\"\ntimes = [0.0, 1.0, 1.5, 4.0, 9.0]\nvalues = [0.0, 5.0, -5.0, 3.0, 0.0]\n";
  }

  std::mt19937 random_;
  bool dissipates_;
  std::ostringstream scene_;
  double velocity_ = 0.0;
};

struct Motions {
  std::vector<double> x, v;
};

Motions run(const std::string& scene, const std::string& method, Index dof, const std::string& more = "") {
  constexpr int kSamples = 240;
  SceneRun run(scene + more, {"integrator.type=" + method});
  std::vector<double> times;
  for (int i = 1; i < kSamples; ++i) times.push_back(12.0 * i / kSamples);
  Sampler sampler(dof, times);
  run.simulation().add(sampler);
  const time::RunReport& report = run.run();
  EXPECT_TRUE(report.completed) << method << ": " << report.message << "\n" << scene;
  return {sampler.x, sampler.v};
}

/// Rounding of either method, relative to the peaks; 1.4e-11 was seen.
constexpr double kRounding = 3e-11;
/// Looser, since `exact` locates these changes on samples; 1.05e-10 was seen once on 584 chains.
constexpr double kEvents = 1e-10;
/// A disturbance whose growth is measured, m/s.
constexpr double kDisturbance = 1e-9;

double peak(const std::vector<double>& y) {
  double largest = 0.0;
  for (const double each : y) largest = std::max(largest, std::abs(each));
  return largest;
}

/// How often two runs were compared.
unsigned compare(const RandomChain& chain, const std::string& method, const std::string& keys, double tolerance,
                 const std::string& name) {
  const Motions ours = run(chain.scene(), "piecewise", 0), reference = run(chain.scene(), method, 0, keys),
                disturbed = run(chain.scene(kDisturbance), "piecewise", 0);
  const double largest_x = peak(reference.x), largest_v = peak(reference.v);
  double growth = 1.0;
  unsigned compared = 0;
  for (std::size_t i = 0; i < reference.x.size(); ++i) {
    growth = std::max({growth, std::abs(disturbed.x[i] - ours.x[i]) / kDisturbance,
                       std::abs(disturbed.v[i] - ours.v[i]) / kDisturbance});
    if (growth > 1e5) break;  // what follows is chance
    EXPECT_NEAR(ours.x.at(i), reference.x[i], tolerance * growth * largest_x) << name << " row " << i;
    EXPECT_NEAR(ours.v.at(i), reference.v[i], tolerance * growth * largest_v) << name << " row " << i;
    if (testing::Test::HasFailure()) {
      ADD_FAILURE() << chain.scene();
      break;
    }
    ++compared;
  }
  return compared;
}

TEST(Piecewise, MeetsExactOnRandomChains) {
  constexpr unsigned kChains = 120;
  unsigned compared = 0;
  for (unsigned seed = 0; seed < kChains && !HasFailure(); ++seed)
    compared += compare(RandomChain(seed), "exact", "", kRounding, "seed " + std::to_string(seed));
  EXPECT_GT(compared, kChains * 150);
}

TEST(Piecewise, MeetsExactWhereStopsDissipate) {
  constexpr unsigned kChains = 60;
  unsigned compared = 0;
  for (unsigned seed = 0; seed < kChains && !HasFailure(); ++seed)
    compared += compare(RandomChain(seed, true), "exact", "", kEvents, "seed " + std::to_string(seed));
  EXPECT_GT(compared, kChains * 150);
}

/// A mass between stops: problem SDND121 of Code_Aster's suite.
constexpr const char* kOneMass = R"(
schema = 1
[[element]]
type = "mass"
name = "m"
mass = 156.0
[[element]]
type = "spring"
node = "m"
stiffness = 2e6
damping = DASHPOT
[[contact]]
type = "stop"
nodes = "m"
gap = 1e-3
law = "linear"
stiffness = 1e10
[[load]]
type = "harmonic"
node = "m"
amplitude = AMPLITUDE
angular_frequency = 31.4159265358979
phase = -1.5707963267948966
[integrator]
type = "piecewise"
end_time = 0.4
)";

std::string one_mass(double dashpot, double amplitude = 3000.0) {
  std::string scene = kOneMass;
  scene.replace(scene.find("DASHPOT"), 7, to_text(dashpot));
  return scene.replace(scene.find("AMPLITUDE"), 9, to_text(amplitude));
}

/// The derivatives of a run, over its steps, and where it ends.
struct Derivatives {
  Eigen::MatrixXd by_start;
  Vector by_loads, end;
};

Derivatives follow(const std::string& scene, const Vector& start = Vector(), double end_time = 0.4) {
  SceneRun run(scene, {"integrator.type=piecewise"});
  auto& method = dynamic_cast<integrators::Piecewise&>(run.integrator());
  time::State from, to;
  const Index n = run.system().size();
  from.t = 0.0;
  from.x = start.size() > 0 ? Vector(start.head(n)) : run.system().initial_displacement;
  from.v = start.size() > 0 ? Vector(start.tail(n)) : run.system().initial_velocity;
  method.start(from);
  Derivatives all{Eigen::MatrixXd::Identity(2 * n, 2 * n), Vector::Zero(2 * n), {}};
  while (from.t < end_time) {
    EXPECT_EQ(method.step(from, {end_time - from.t, end_time}, to).status, time::StepStatus::ok);
    const Eigen::MatrixXd step = method.derivative(from, to);
    all.by_start = step * all.by_start;
    all.by_loads = step * all.by_loads + method.derivative_by_loads(from, to);
    std::swap(from, to);
  }
  all.end.resize(2 * n);
  all.end << from.x, from.v;
  return all;
}

TEST(Piecewise, FindsTheInstantsOfContact) {
  // exact itself is uncertain by 1e-10 s at the end, where the motion has magnified rounding.
  constexpr double kInstants = 1e-9;
  std::vector<record::Impact> all[2];
  for (const std::string method : {"piecewise", "exact"}) {
    SceneRun run(one_mass(0.0), {"integrator.type=" + method, "integrator.end_time=4.0"});
    record::ImpactRecorder recorder(run.dynamics());
    run.simulation().add(recorder);
    ASSERT_TRUE(run.run().completed);
    all[method == "exact" ? 1 : 0] = recorder.impacts();
  }
  ASSERT_EQ(all[0].size(), 148U);
  ASSERT_EQ(all[1].size(), 148U);
  for (std::size_t i = 0; i < all[0].size(); ++i) {
    EXPECT_NEAR(all[0][i].t_in, all[1][i].t_in, kInstants);
    EXPECT_NEAR(*all[0][i].t_out, *all[1][i].t_out, kInstants);
    EXPECT_NEAR(all[0][i].peak_force / all[1][i].peak_force, 1.0, 1e-6);
  }
}

TEST(Piecewise, DerivativeHasTheDeterminantOfTheDamping) {
  for (const double dashpot : {0.0, 100.0, 2000.0})
    // Forces are continuous, so that volume in phase space shrinks with c/m alone; the product of some 30 matrices.
    EXPECT_NEAR(follow(one_mass(dashpot)).by_start.determinant() / std::exp(-dashpot / 156.0 * 0.4), 1.0, 1e-9);
}

TEST(Piecewise, DerivativeMeetsDifferences) {
  constexpr double kEnd = 1.5, kDifference = 1e-6;
  int compared = 0;
  for (unsigned seed = 0; seed < 24; ++seed) {
    const RandomChain chain(seed, seed % 2 == 1);
    SceneRun run(chain.scene());
    const Index n = run.system().size();
    Vector start(2 * n);
    start << run.system().initial_displacement, run.system().initial_velocity;
    const Derivatives here = follow(chain.scene(), start, kEnd);
    Eigen::MatrixXd difference(2 * n, 2 * n);
    double bend = 0.0;
    for (Index i = 0; i < 2 * n; ++i) {
      Vector ahead = start, back = start;
      ahead[i] += kDifference;
      back[i] -= kDifference;
      const Vector up = follow(chain.scene(), ahead, kEnd).end, down = follow(chain.scene(), back, kEnd).end;
      difference.col(i) = (up - down) / (2.0 * kDifference);
      bend = std::max(bend, (up + down - 2.0 * here.end).cwiseAbs().maxCoeff() / kDifference);
    }
    // Where one side of the difference meets another contact, or the second derivative is large, it tells nothing.
    if (bend > 1e-3 * difference.cwiseAbs().maxCoeff()) continue;
    EXPECT_LT((here.by_start - difference).cwiseAbs().maxCoeff(), 1e-4 * difference.cwiseAbs().maxCoeff())
        << "seed " << seed << "\n"
        << here.by_start << "\n\n"
        << difference << chain.scene();
    ++compared;
  }
  EXPECT_GE(compared, 14);
}

TEST(Piecewise, DerivativeByLoadsMeetsDifferences) {
  constexpr double kPart = 1e-7;
  const Vector up = follow(one_mass(100.0, 3000.0 * (1.0 + kPart))).end,
               down = follow(one_mass(100.0, 3000.0 * (1.0 - kPart))).end;
  const Vector difference = (up - down) / (2.0 * kPart), ours = follow(one_mass(100.0)).by_loads;
  for (Index i = 0; i < 2; ++i) EXPECT_NEAR(ours[i] / difference[i], 1.0, 1e-4);
}

TEST(Piecewise, RefusesOtherScenesBeforeTheFirstStep) {
  const std::string scene = one_mass(0.0);
  const auto message_of = [](const std::string& toml, const std::vector<std::string>& overrides) -> std::string {
    try {
      SceneRun run(toml, overrides);
    } catch (const InputError& error) {
      return error.what();
    }
    return "taken";
  };
  EXPECT_EQ(message_of(scene, {}), "taken");
  EXPECT_NE(message_of(scene, {"contact[0].law=arctan", "contact[0].regularization=7e7"}).find("law = \"linear\""),
            std::string::npos);
  EXPECT_NE(message_of(with_linear_law("beam1"), {"integrator.type=piecewise"}).find("68 DOFs are more than the 24"),
            std::string::npos);
  EXPECT_NE(message_of(scene, {"contact[0].damping={type=\"hunt_crossley\",factor=0.1}"}).find("Kelvin-Voigt"),
            std::string::npos);
}

/// x'' + omega^2 x = f cos(omega t) from rest is f t sin(omega t)/(2 omega); so near to resonance the closed form of
/// the driven motion would lose all digits.
TEST(Piecewise, FollowsResonance) {
  const std::string scene =
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 1.0\n[[element]]\ntype = \"spring\"\nnode = "
      "\"m\"\nstiffness = 9.0\n[[load]]\ntype = \"harmonic\"\nnode = \"m\"\namplitude = 2.0\n[integrator]\ntype = "
      "\"piecewise\"\nend_time = 50.0\n";
  for (const double detuning : {0.0, 1e-13, 1e-9, 1e-6, 1e-4, 1e-2}) {
    const double omega = 3.0 * (1.0 + detuning);
    SceneRun run(scene, {"load[0].angular_frequency=" + to_text(omega)});
    ASSERT_TRUE(run.run().completed);
    // 2 sin(a) sin(b)/((omega - 3)(omega + 3)) with the half difference and sum of the phases.
    const long double half = 0.5L * 3.0L * detuning * 50.0L, sum = 3.0L * 50.0L + half;
    const long double beat = half == 0.0L ? 1.0L : std::sin(half) / half;
    const long double x = 2.0L * 50.0L * beat * std::sin(sum) / (static_cast<long double>(omega) + 3.0L);
    // The load's frequency as a double is the largest error: 50 omega eps of the phase.
    EXPECT_NEAR(run.simulation().state().x[0], static_cast<double>(x), 2e-12 * 50.0) << detuning;
  }
}

/// A free mass under a constant force, with so little damping that m g/c is a million times its way, strikes a stop.
TEST(Piecewise, FallsFreelyWithNextToNoDamping) {
  for (const double rate : {0.0, 1e-12, 1e-6, 1e-3, 10.0}) {
    SceneRun run(
        "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 2.0\n[[load]]\ntype = "
        "\"constant\"\nnode = \"m\"\nvalue = -20.0\n[[contact]]\ntype = \"stop\"\nnodes = \"m\"\ngap = "
        "100.0\nlaw = \"linear\"\nstiffness = 1e6\n[damping]\nmass_proportional = " +
        to_text(rate) + "\n[integrator]\ntype = \"piecewise\"\nend_time = 3.0\n");
    ASSERT_TRUE(run.run().completed);
    const long double c = rate, t = 3.0L;
    // x = -g (t - (1 - e^(-c t))/c)/c, or its series.
    const long double x = rate < 1e-4 ? -10.0L * t * t * (0.5L - c * t / 6.0L + c * c * t * t / 24.0L)
                                      : -10.0L * (t + std::expm1(-c * t) / c) / c;
    EXPECT_NEAR(run.simulation().state().x[0] / static_cast<double>(x), 1.0, 1e-13) << rate;
  }
}

/// A start on the border of the stop, at rest: the first derivative that is not zero decides.
TEST(Piecewise, DecidesStartsOnTheBorder) {
  for (const char* load : {"type = \"constant\"\nvalue = 3.0\n", "type = \"constant\"\nvalue = -3.0\n",
                           "type = \"ramp\"\nto = 3.0\nend = 0.5\n", "type = \"ramp\"\nto = -3.0\nend = 0.5\n",
                           "type = \"constant\"\nvalue = 0.0\n"}) {
    const std::string scene =
        std::string(
            "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 1.0\n[[contact]]\ntype = "
            "\"stop\"\nnodes = \"m\"\ngap = 0.125\nsides = \"positive\"\nlaw = \"linear\"\nstiffness = "
            "1e4\n[initial]\ndisplacement = [{ nodes = \"m\", value = 0.125 }]\n[[load]]\nnode = \"m\"\n") +
        load + "[integrator]\nend_time = 0.9\n";
    SceneRun ours(scene, {"integrator.type=piecewise"}), reference(scene, {"integrator.type=exact"});
    ASSERT_TRUE(ours.run().completed);
    ASSERT_TRUE(reference.run().completed);
    EXPECT_NEAR(ours.simulation().state().x[0], reference.simulation().state().x[0], 1e-13) << load;
    EXPECT_LT(ours.simulation().report().steps, 200) << load;
  }
}

/// A run whose steps end elsewhere, as with other outputs, and one that is taken up in its middle.
TEST(Piecewise, GoesOnFromASnapshotToTheSameBits) {
  const std::string scene = one_mass(50.0);
  SceneRun whole(scene), parts(scene, {"integrator.end_time=0.4"});
  ASSERT_TRUE(whole.run().completed);
  parts.simulation().set_end_time(0.4);
  ASSERT_TRUE(parts.run().completed);
  EXPECT_TRUE(whole.simulation().state().x == parts.simulation().state().x);
  EXPECT_GE(dynamic_cast<integrators::Piecewise&>(whole.integrator()).states_made(), 2);
}

}  // namespace
}  // namespace butee::test::piecewise_test
