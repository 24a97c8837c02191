#include "contact/arctan.hpp"

#include "contact/laws.hpp"

namespace butee::contact {

namespace {

/// Fewer stops than this are quicker one by one.
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
