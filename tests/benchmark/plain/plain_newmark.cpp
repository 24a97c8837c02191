#include <chrono>
#include <limits>
#include <utility>

#include "plain_contact.hpp"
#include "plain_stepping.hpp"

namespace plain {
namespace {

double norm_of(const Vector<double>& x) {
  const double* px = x.data();
  const int n = x.size();
  double sum = 0.0;
#pragma omp simd reduction(+ : sum)
  for (int i = 0; i < n; ++i) sum += px[i] * px[i];
  return std::sqrt(sum);
}

class Newmark {
 public:
  Newmark(const Problem& problem, const Options& options)
      : p_(problem), o_(options), contact_(problem), base_(problem.size()), effective_(problem.size()) {
    for (auto* vector : {&x, &v, &a_, &x1_, &v1_, &a1_, &r_}) *vector = Vector<double>(problem.size());
    contact_.evaluate_force(x);  // at rest
    for (std::size_t k = 0; k < p_.stops.size(); ++k) a_[p_.stops[k]] += contact_.force[k];
    a_[p_.loaded] += load(0.0);
    factor_.compute(problem.mass);
    factor_.solve(a_);
    factored_for_ = 0.0;
  }

  /// A step with Newton iterations, stored separately; false if they do not converge.
  bool try_newton(double t, double h, Result& result) {
    const int n = p_.size();
    const double gh = o_.gamma * h, bh2 = o_.beta * h * h, f = load(t + h);
    for (int i = 0; i < n; ++i) {
      a1_[i] = a_[i];
      v1_[i] = v[i] + h * a_[i];
      x1_[i] = x[i] + h * v[i] + 0.5 * h * h * a_[i];
    }
    double dx = 0.0;
    for (int iteration = 0;; ++iteration) {
      contact_.evaluate_tangent(x1_);
      const double scale = residual(f);
      const double x_norm = norm_of(x1_);
      if (norm_of(r_) <= o_.newton_tolerance * scale && dx <= o_.newton_tolerance * x_norm) return true;
      if (iteration == o_.max_iterations || !std::isfinite(scale)) break;
      factorize(h);
      factor_.solve(r_);
      ++result.newton;
      for (int i = 0; i < n; ++i) {
        a1_[i] += r_[i];
        v1_[i] += gh * r_[i];
        x1_[i] += bh2 * r_[i];
      }
      dx = bh2 * norm_of(r_);
    }
    ++result.newton_failures;
    return false;
  }

  /// A step with the secant stiffness at its start, stored separately.
  void try_secant(double t, double h) {
    const int n = p_.size();
    const double gh = o_.gamma * h, bh2 = o_.beta * h * h;
    contact_.evaluate_secant(x);
    for (int i = 0; i < n; ++i) {
      x1_[i] = x[i] + h * v[i] + (0.5 - o_.beta) * h * h * a_[i];
      v1_[i] = v[i] + (1.0 - o_.gamma) * h * a_[i];
    }
    const double *px = x1_.data(), *pv = v1_.data();
    double* pa = a1_.data();
#pragma omp simd
    for (int i = 0; i < n; ++i) pa[i] = -p_.damping.row_times(i, pv) - p_.stiffness.row_times(i, px);
    for (std::size_t k = 0; k < p_.stops.size(); ++k) {
      const int i = p_.stops[k];
      pa[i] += contact_.offset[k] - contact_.stiffness[k] * px[i];
    }
    pa[p_.loaded] += load(t + h);
    factorize(h);
    factor_.solve(a1_);
    for (int i = 0; i < n; ++i) {
      v1_[i] += gh * a1_[i];
      x1_[i] += bh2 * a1_[i];
    }
  }

  /// |beta - 1/6| h^2 |a_{n+1} - a_n| / |x_{n+1} - x_n|; negative without motion.
  double error(double h) const {
    double da = 0.0, dx = 0.0;
    for (int i = 0; i < p_.size(); ++i) {
      da += (a1_[i] - a_[i]) * (a1_[i] - a_[i]);
      dx += (x1_[i] - x[i]) * (x1_[i] - x[i]);
    }
    return dx == 0.0 ? -1.0 : std::abs(o_.beta - 1.0 / 6.0) * h * h * std::sqrt(da) / std::sqrt(dx);
  }

  void keep() {
    std::swap(x, x1_);
    std::swap(v, v1_);
    std::swap(a_, a1_);
  }

  Vector<double> x, v;

 private:
  double load(double t) const {
    return p_.amplitude * std::cos(p_.angular_frequency * t);
  }

  /// r = F + F_c - M a - C v - K x; returns |F| + |F_c| + |M a| + |C v| + |K x|.
  double residual(double f) {
    const int n = p_.size();
    const double *px = x1_.data(), *pv = v1_.data(), *pa = a1_.data();
    double* r = r_.data();
    double inertia = 0.0, damping = 0.0, stiffness = 0.0, contact = 0.0;
#pragma omp simd reduction(+ : inertia, damping, stiffness)
    for (int i = 0; i < n; ++i) {
      const double ma = p_.mass.row_times(i, pa), cv = p_.damping.row_times(i, pv), kx = p_.stiffness.row_times(i, px);
      inertia += ma * ma;
      damping += cv * cv;
      stiffness += kx * kx;
      r[i] = -(ma + cv + kx);
    }
    for (std::size_t k = 0; k < p_.stops.size(); ++k) {
      r[p_.stops[k]] += contact_.force[k];
      contact += contact_.force[k] * contact_.force[k];
    }
    r[p_.loaded] += f;
    return std::abs(f) + std::sqrt(contact) + std::sqrt(inertia) + std::sqrt(damping) + std::sqrt(stiffness);
  }

  /// A = M + gamma h C + beta h^2 (K + stops); factorized only if it has changed.
  void factorize(double h) {
    if (h == factored_for_ && contact_.stiffness == factored_stops_) return;
    const double gh = o_.gamma * h, bh2 = o_.beta * h * h;
    if (h != factored_for_)
      for (std::size_t k = 0; k < base_.lower.size(); ++k)
        for (int i = 0; i < p_.size(); ++i)
          base_.lower[k][i] = p_.mass.lower[k][i] + gh * p_.damping.lower[k][i] + bh2 * p_.stiffness.lower[k][i];
    effective_ = base_;
    for (std::size_t k = 0; k < p_.stops.size(); ++k) effective_.lower[0][p_.stops[k]] += bh2 * contact_.stiffness[k];
    factor_.compute(effective_);
    factored_for_ = h;
    factored_stops_ = contact_.stiffness;
  }

  const Problem& p_;
  const Options& o_;
  Contact contact_;
  Band<double> base_, effective_;
  BandFactor<double> factor_;
  double factored_for_ = 0.0;
  std::vector<double> factored_stops_;
  Vector<double> a_, x1_, v1_, a1_, r_;
};

Verdict judge(double error, double h, const Options& options) {
  if (std::isnan(error) || std::isinf(error)) return {false, 0.5 * h};
  if (error < 0.0) return {true, h};
  const double low = options.band_low * options.target_error, high = options.band_high * options.target_error;
  if (error >= low && error <= high) return {true, h};
  const double next =
      error > 0.0 ? h * std::sqrt(options.target_error / error) : std::numeric_limits<double>::infinity();
  return {error < low, next};
}

}  // namespace

void run_newmark(const Problem& problem, Method method, const Options& options, Result& result) {
  Newmark newmark(problem, options);
  const auto keep = [&](double t, double h) {
    newmark.keep();
    record(result, options, t, h, newmark.x[problem.loaded], newmark.v[problem.loaded]);
  };
  const bool secant = method == Method::kNmm1 || method == Method::kNmm2;
  const bool adaptive = method == Method::kNm2 || method == Method::kNmm2;
  if (!adaptive) {
    march_fixed(options, [&](double t, double h) {
      if (secant)
        newmark.try_secant(t, h);
      else
        newmark.try_newton(t, h, result);
      keep(t, h);
    });
    return;
  }
  march_adaptive(options, result, [&](double t, double h) -> Verdict {
    if (secant)
      newmark.try_secant(t, h);
    else if (!newmark.try_newton(t, h, result))
      return {false, 0.5 * h};
    const Verdict verdict = judge(newmark.error(h), h, options);
    if (verdict.accepted) keep(t, h);
    return verdict;
  });
}

Result run(const Problem& problem, Method method, const Options& options) {
  Result result;
  const auto start = std::chrono::steady_clock::now();
  const bool runge_kutta = method == Method::kRk41 || method == Method::kRk42 || method == Method::kRk43;
  (runge_kutta ? run_runge_kutta : run_newmark)(problem, method, options, result);
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace plain
