#pragma once

#include <cmath>
#include <random>
#include <sstream>
#include <string>

#include <butee/core/text.hpp>

namespace butee::test {

/// A chain of 1 to 4 masses with random springs, dashpots, damping, loads and stops that `piecewise` accepts.
/// Stops have Kelvin-Voigt damping if it `dissipates`.
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

/// A mass between stops: problem SDND121 of Code_Aster's suite.
inline constexpr const char* kOneMass = R"(
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

inline std::string one_mass(double dashpot, double amplitude = 3000.0) {
  std::string scene = kOneMass;
  scene.replace(scene.find("DASHPOT"), 7, to_text(dashpot));
  return scene.replace(scene.find("AMPLITUDE"), 9, to_text(amplitude));
}

}  // namespace butee::test
