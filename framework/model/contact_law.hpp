#pragma once

#include <limits>
#include <memory>
#include <span>

#include <butee/export.hpp>

namespace butee::model {

/// The Taylor coefficients of F(g(s)), computed one after the other.
class BUTEE_EXPORT ForceSeries {
 public:
  virtual ~ForceSeries() = default;
  /// Coefficient n of F(g(s)) from the coefficients 0 ... n of g; called for n = 0, 1, 2, ...; n =
  /// 0 starts a new series.
  virtual double next(std::span<const double> g) = 0;
};

/// The law of an elastic stop as stateless functions of the penetration g (m; negative while open).
///
///     F = K_c(g) g,   dF/dg,   V(g) with dV/dg = F and V(0) = 0
///
/// F pushes the body back if positive. Sides and signs are handled by the stop, not the law.
class BUTEE_EXPORT ContactLaw {
 public:
  virtual ~ContactLaw() = default;

  virtual double secant(double g) const = 0;   ///< K_c(g), N/m
  virtual double tangent(double g) const = 0;  ///< d(K_c g)/dg, N/m
  virtual double energy(double g) const = 0;   ///< V(g), J

  /// K_c for many stops at once.
  virtual void secants(std::span<const double> g, std::span<double> secant) const = 0;
  /// K_c and the tangent for many stops at once.
  virtual void tangents(std::span<const double> g, std::span<double> secant, std::span<double> tangent) const = 0;

  /// The stiffness of the closed stop, N/m, for bounds on the step size.
  virtual double closed_stiffness() const = 0;

  /// How the force of a law with its own dissipation depends on the rate of penetration g'.
  enum class RateDependence {
    none,     ///< F = K_c(g) g
    smooth,   ///< smooth in g' while closed
    by_sense  ///< smooth in approach (g' >= 0) and in rebound (g' < 0) separately; steps end at a sign change of g'
  };
  virtual RateDependence rate_dependence() const { return RateDependence::none; }

  /// F and its derivatives, N, N/m, N s/m.
  struct RatedForce {
    double force, by_penetration, by_rate;
  };
  /// F(g, g') of a closed stop, g > 0, of a law with rate_dependence(). K_c(g) g = F(g, 0) is the
  /// part that energy() stores, and (F - K_c g) g' >= 0 is dissipated. If F < 0 no force acts.
  /// `recedes` selects the rebound branch of a law by_sense; both branches are continued beyond
  /// g' = 0.
  virtual RatedForce rated_force(double g, double /*rate*/, bool /*recedes*/) const {
    return {secant(g) * g, tangent(g), 0.0};
  }

  /// True for F = k_c max(g, 0), whose slope discontinuity methods may locate.
  virtual bool is_piecewise_linear() const { return false; }

  /// True if no force acts while the stop is open: at openings from 1 m down to 1e-16 m.
  bool is_silent_while_open() const {
    for (double opening = 1.0; opening > 1e-16; opening *= 0.1)
      if (secant(-opening) != 0.0) return false;
    return true;
  }

  /// The series of a smooth law; nullptr if it has none.
  virtual std::unique_ptr<ForceSeries> force_series() const { return nullptr; }

  /// The |g| up to which the force departs from that of a linear stop by more than
  /// asymptotic_force(), m; infinite if not known.
  virtual double transition_width() const { return std::numeric_limits<double>::infinity(); }

  /// The largest force that a stop still exerts when it is open by more than a few boundary layers,
  /// N (0: none).
  virtual double asymptotic_force() const { return 0.0; }
};

/// Implements the loops over many stops for a law: `class Mine final : public BatchedLaw<Mine>`.
template <class Law>
class BatchedLaw : public ContactLaw {
 public:
  void secants(std::span<const double> g, std::span<double> secant) const final {
    for (std::size_t i = 0; i < g.size(); ++i) secant[i] = law().Law::secant(g[i]);
  }
  void tangents(std::span<const double> g, std::span<double> secant, std::span<double> tangent) const final {
    for (std::size_t i = 0; i < g.size(); ++i) {
      secant[i] = law().Law::secant(g[i]);
      tangent[i] = law().Law::tangent(g[i]);
    }
  }

 private:
  const Law& law() const { return static_cast<const Law&>(*this); }
};

}  // namespace butee::model
