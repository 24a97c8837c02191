#include "contact/arctan.hpp"

#include <vector>

#include "contact/laws.hpp"

namespace butee::contact {

namespace {

/// With fewer stops than this, evaluation one by one is faster.
constexpr std::size_t kFew = 4;

}  // namespace

void Arctan::secants(std::span<const double> g, std::span<double> secant) const {
  if (g.size() < kFew) {
    for (std::size_t i = 0; i < g.size(); ++i) secant[i] = Arctan::secant(g[i]);
    return;
  }
  int near = 0;
  for (std::size_t i = 0; i < g.size(); ++i) {
    const double x = slope_ * g[i], y = std::abs(x), open = far_fraction(y);
    near += y <= kFar ? 1 : 0;
    secant[i] = stiffness_ * (x < 0.0 ? open : 1.0 - open);
  }
  if (near == 0) return;
  for (std::size_t i = 0; i < g.size(); ++i)
    if (std::abs(slope_ * g[i]) <= kFar) secant[i] = Arctan::secant(g[i]);
}

void Arctan::tangents(std::span<const double> g, std::span<double> secant, std::span<double> tangent) const {
  if (g.size() < kFew) {
    for (std::size_t i = 0; i < g.size(); ++i) {
      secant[i] = Arctan::secant(g[i]);
      tangent[i] = Arctan::tangent(g[i]);
    }
    return;
  }
  int near = 0;
  for (std::size_t i = 0; i < g.size(); ++i) {
    const double x = slope_ * g[i], y = std::abs(x), open = far_fraction(y), open_tangent = far_tangent_fraction(y);
    near += y <= kFar ? 1 : 0;
    secant[i] = stiffness_ * (x < 0.0 ? open : 1.0 - open);
    tangent[i] = stiffness_ * (x < 0.0 ? open_tangent : 1.0 - open_tangent);
  }
  if (near == 0) return;
  for (std::size_t i = 0; i < g.size(); ++i) {
    if (std::abs(slope_ * g[i]) > kFar) continue;
    secant[i] = Arctan::secant(g[i]);
    tangent[i] = Arctan::tangent(g[i]);
  }
}

namespace {

/// F = K_c(g) g with K_c = k_c (1/2 + y/pi), y = atan z, z = pi lambda g, by y' (1 + z^2) = z'.
class ArctanSeries final : public model::ForceSeries {
 public:
  ArctanSeries(const Arctan& law, double stiffness, double slope) : law_(law), stiffness_(stiffness), slope_(slope) {}

  double next(std::span<const double> g) override {
    const std::size_t n = g.size() - 1;
    y_.resize(n + 1);
    square_.resize(n + 1);
    secant_.resize(n + 1);
    square_[n] = n == 0 ? 1.0 : 0.0;
    for (std::size_t j = 0; j <= n; ++j) square_[n] += slope_ * g[j] * slope_ * g[n - j];
    if (n == 0) {
      secant_[0] = law_.secant(g[0]);
    } else {
      double sum = static_cast<double>(n) * slope_ * g[n];
      for (std::size_t j = 1; j < n; ++j) sum -= static_cast<double>(j) * y_[j] * square_[n - j];
      y_[n] = sum / (static_cast<double>(n) * square_[0]);
      secant_[n] = stiffness_ * y_[n] * std::numbers::inv_pi;
    }
    double force = 0.0;
    for (std::size_t j = 0; j <= n; ++j) force += secant_[j] * g[n - j];
    return force;
  }

 private:
  const Arctan& law_;
  double stiffness_, slope_;
  std::vector<double> y_, square_, secant_;  ///< coefficients of y, 1 + z^2 and K_c
};

}  // namespace

std::unique_ptr<model::ForceSeries> Arctan::force_series() const {
  return std::make_unique<ArctanSeries>(*this, stiffness_, slope_);
}

model::LawType arctan_type() {
  return {"arctan",
          "regularised stop: F = k_c/2 [2/pi atan(pi lambda g) + 1] g",
          {config::number("stiffness", "N/m", "the stiffness k_c of the closed stop").above(0),
           config::number("regularization", "1/m", "lambda, the inverse width of the transition").above(0)},
          [](const config::Parameters& p, config::Diagnostics&) -> std::unique_ptr<model::ContactLaw> {
            return std::make_unique<Arctan>(p.number("stiffness"), p.number("regularization"));
          }};
}

}  // namespace butee::contact
