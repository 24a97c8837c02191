#include "integrators/zienkiewicz_xie.hpp"

#include <cmath>

namespace butee::integrators {

double ZienkiewiczXie::error(const time::State& from, const time::State& to, double h) const {
  const double motion = (to.x - from.x).norm();
  if (motion == 0.0) return kNoMotion;
  return factor_ * h * h * (to.a - from.a).norm() / motion;
}

time::StepDecision ZienkiewiczXie::decide(double h, const time::StepReport& report) const {
  const double eta = report.error;
  if (eta == kNoMotion || (lower_ * target_ <= eta && eta <= upper_ * target_)) return {true, h};
  return {eta < lower_ * target_, h * std::sqrt(target_ / eta)};
}

std::vector<config::Parameter> ZienkiewiczXie::parameters() {
  using config::Array, config::Value;
  return {config::number("target_error", "1", "eta_e, the local error aimed at").above(0).sweep(1e-1, 1e-7),
          config::numbers("band", "1", "nu1 and nu2: the step stays while eta is within nu1 eta_e and nu2 eta_e")
              .of_length(2)
              .above(0)
              .or_else(Array{Value(0.5), Value(4.0)})};
}

std::unique_ptr<ZienkiewiczXie> ZienkiewiczXie::make(const config::Parameters& p) {
  const auto band = p.numbers("band");
  return std::make_unique<ZienkiewiczXie>(p.number("beta"), p.number("target_error"), band[0], band[1]);
}

void ZienkiewiczXie::check(const config::Parameters& p, config::Diagnostics& diagnostics) {
  const auto band = p.numbers("band");
  if (!(band[0] <= 1.0 && 1.0 <= band[1]))
    p.complain(diagnostics, "band", "must contain 1 between its two values, or the step would never settle");
  if (std::abs(p.number("beta") - 1.0 / 6.0) < 1e-6)
    p.complain(diagnostics, "beta",
               "makes the error estimate vanish: it is |beta - 1/6| h^2 |da|/|dx|; choose another, such as 0.25");
}

}  // namespace butee::integrators
