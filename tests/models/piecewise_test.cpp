// The method in closed form against exact, which expands in series and finds changes as roots of polynomials, and against
// closed forms. Random chains have all kinds of stops, damping and loads that it takes.
#include <algorithm>
#include <cmath>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "integrators/piecewise.hpp"
#include "support/scene_run.hpp"

namespace butee::test::piecewise_test {
namespace {

class RandomChain {
 public:
  explicit RandomChain(unsigned seed) : random_(seed) {
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
    initial_ = scene_.str().size();
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
           << ends << "\ngap = " << (chance(0.1) ? 0.0 : 0.2 * uniform()) << "\nsides = \""
           << (sides < 0.4 ? "both" : sides < 0.7 ? "positive" : "negative")
           << "\"\nlaw = \"linear\"\nstiffness = " << log_uniform(10.0, 1e5) << "\n";
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
  std::ostringstream scene_;
  std::size_t initial_ = 0;
  double velocity_ = 0.0;
};

struct Motions {
  std::vector<double> x, v;
  std::int64_t steps = 0;
  double t_end = 0.0;
};

Motions run(const std::string& scene, const std::string& method, Index dof) {
  constexpr int kSamples = 240;
  SceneRun run(scene, {"integrator.type=" + method});
  std::vector<double> times;
  for (int i = 1; i < kSamples; ++i) times.push_back(12.0 * i / kSamples);
  Sampler sampler(dof, times);
  run.simulation().add(sampler);
  const time::RunReport& report = run.run();
  EXPECT_TRUE(report.completed) << method << ": " << report.message << "\n" << scene;
  return {sampler.x, sampler.v, report.steps, report.t_end};
}

/// Rounding of either method, relative to the peaks.
constexpr double kRounding = 1e-12;
/// A disturbance whose growth is measured, m/s.
constexpr double kDisturbance = 1e-9;

double peak(const std::vector<double>& y) {
  double largest = 0.0;
  for (const double each : y) largest = std::max(largest, std::abs(each));
  return largest;
}

TEST(Piecewise, MeetsExactOnRandomChains) {
  constexpr unsigned kChains = 120;
  unsigned compared = 0;
  double worst = 0.0;
  for (unsigned seed = 0; seed < kChains; ++seed) {
    const RandomChain chain(seed);
    const Index dof = 0;
    const Motions ours = run(chain.scene(), "piecewise", dof), reference = run(chain.scene(), "exact", dof),
                  disturbed = run(chain.scene(kDisturbance), "exact", dof);
    const double largest_x = peak(reference.x), largest_v = peak(reference.v);
    double growth = 1.0;
    for (std::size_t i = 0; i < reference.x.size(); ++i) {
      growth = std::max({growth, std::abs(disturbed.x[i] - reference.x[i]) / kDisturbance,
                         std::abs(disturbed.v[i] - reference.v[i]) / kDisturbance});
      if (growth > 1e5) break;  // what follows is chance
      ASSERT_NEAR(ours.x.at(i), reference.x[i], 20.0 * kRounding * growth * largest_x)
          << "seed " << seed << " row " << i << "\n"
          << chain.scene();
      ASSERT_NEAR(ours.v.at(i), reference.v[i], 20.0 * kRounding * growth * largest_v)
          << "seed " << seed << " row " << i << "\n"
          << chain.scene();
      worst = std::max({worst, std::abs(ours.v.at(i) - reference.v[i]) / (growth * largest_v)});
      ++compared;
    }
  }
  RecordProperty("worst", std::to_string(worst));
  std::printf("worst %g compared %u\n", worst, compared);
  EXPECT_GT(compared, kChains * 150);
}

}  // namespace
}  // namespace butee::test::piecewise_test
