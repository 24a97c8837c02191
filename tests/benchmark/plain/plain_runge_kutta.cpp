#include <utility>

#include "plain_contact.hpp"
#include "plain_stepping.hpp"

namespace plain {
namespace {

class RungeKutta {
 public:
  explicit RungeKutta(const Problem& problem) : p_(problem), contact_(problem) {
    factor_.compute(problem.mass);
    for (auto* vector :
         {&x, &v, &x_full_, &v_full_, &x_half_, &v_half_, &x_stage_, &v2_, &v3_, &v4_, &a1_, &a2_, &a3_, &a4_})
      *vector = Vector<double>(problem.size());
  }

  /// One step of size h in place.
  void step(double t, double h) {
    accelerate(t, x, v, a1_);
    step_from(t, h, x, v, x, v);
  }

  /// One step of size h and two of size h/2, stored separately; returns the error estimate from their
  /// difference.
  double step_doubled(double t, double h) {
    accelerate(t, x, v, a1_);
    step_from(t, h, x, v, x_full_, v_full_);
    step_from(t, 0.5 * h, x, v, x_half_, v_half_);
    accelerate(t + 0.5 * h, x_half_, v_half_, a1_);
    step_from(t + 0.5 * h, 0.5 * h, x_half_, v_half_, x_half_, v_half_);
    double largest = 0.0, sum = 0.0;
    for (int i = 0; i < p_.size(); ++i) {
      const double dx = x_half_[i] - x_full_[i], dv = v_half_[i] - v_full_[i];
      largest = std::max(largest, std::max(std::abs(dx), std::abs(dv)));
      sum += dx + dv;
    }
    return std::isfinite(sum) ? largest / 15.0 : sum;
  }

  void keep_halves() {
    std::swap(x, x_half_);
    std::swap(v, v_half_);
  }

  Vector<double> x, v;

 private:
  /// a = M^-1 (F(t) + F_c(x) - C v - K x)
  void accelerate(double t, const Vector<double>& x_at, const Vector<double>& v_at, Vector<double>& a) {
    const int n = p_.size();
    const double *px = x_at.data(), *pv = v_at.data();
    double* pa = a.data();
    contact_.evaluate_force(x_at);
#pragma omp simd
    for (int i = 0; i < n; ++i) pa[i] = -p_.damping.row_times(i, pv) - p_.stiffness.row_times(i, px);
    for (std::size_t k = 0; k < p_.stops.size(); ++k) pa[p_.stops[k]] += contact_.force[k];
    pa[p_.loaded] += p_.amplitude * std::cos(p_.angular_frequency * t);
    factor_.solve(a);
  }

  void stage(double h, const Vector<double>& x0, const Vector<double>& v0, const Vector<double>& slope,
             const Vector<double>& a, Vector<double>& v_out) {
    for (int i = 0; i < p_.size(); ++i) {
      x_stage_[i] = x0[i] + h * slope[i];
      v_out[i] = v0[i] + h * a[i];
    }
  }

  /// The classical Runge-Kutta step, given a1_ = a(t, x0, v0); the result may overwrite the start.
  void step_from(double t, double h, const Vector<double>& x0, const Vector<double>& v0, Vector<double>& x1,
                 Vector<double>& v1) {
    stage(0.5 * h, x0, v0, v0, a1_, v2_);
    accelerate(t + 0.5 * h, x_stage_, v2_, a2_);
    stage(0.5 * h, x0, v0, v2_, a2_, v3_);
    accelerate(t + 0.5 * h, x_stage_, v3_, a3_);
    stage(h, x0, v0, v3_, a3_, v4_);
    accelerate(t + h, x_stage_, v4_, a4_);
    for (int i = 0; i < p_.size(); ++i) {
      const double slope = v0[i] + 2.0 * (v2_[i] + v3_[i]) + v4_[i];
      v1[i] = v0[i] + h / 6.0 * (a1_[i] + 2.0 * (a2_[i] + a3_[i]) + a4_[i]);
      x1[i] = x0[i] + h / 6.0 * slope;
    }
  }

  const Problem& p_;
  Contact contact_;
  BandFactor<double> factor_;
  Vector<double> x_full_, v_full_, x_half_, v_half_, x_stage_, v2_, v3_, v4_, a1_, a2_, a3_, a4_;
};

Verdict judge_fixed_factors(double error, double h, const Options& options) {
  if (!std::isfinite(error)) return {false, 0.5 * h};
  if (error <= options.tolerance / 100.0) return {true, options.grow * h};
  if (error <= options.tolerance) return {true, h};
  return {false, h / options.shrink};
}

Verdict judge_error_scaled(double error, double h, const Options& options) {
  if (!std::isfinite(error)) return {false, 0.5 * h};
  const bool accepted = error <= options.tolerance;
  return {accepted, options.safety * h * std::pow(options.tolerance / error, accepted ? 0.2 : 0.25)};
}

}  // namespace

void run_runge_kutta(const Problem& problem, Method method, const Options& options, Result& result) {
  RungeKutta rk(problem);
  if (method == Method::kRk41) {
    march_fixed(options, [&](double t, double h) {
      rk.step(t, h);
      record(result, options, t, h, rk.x[problem.loaded], rk.v[problem.loaded]);
    });
    return;
  }
  march_adaptive(options, result, [&](double t, double h) {
    const double error = rk.step_doubled(t, h);
    const Verdict verdict =
        method == Method::kRk42 ? judge_fixed_factors(error, h, options) : judge_error_scaled(error, h, options);
    if (verdict.accepted) {
      rk.keep_halves();
      record(result, options, t, h, rk.x[problem.loaded], rk.v[problem.loaded]);
    }
    return verdict;
  });
}

}  // namespace plain
