#include "butee/dynamics/buckling.hpp"

#include <algorithm>
#include <limits>

#include <Eigen/SparseCholesky>

#include "butee/model/system.hpp"

namespace butee::dynamics {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Relative distance of the bounds at which bisection ends.
constexpr double kBisected = 1e-13;

SparseMatrix symmetric_stiffness(const model::Model& model) {
  const SparseMatrix k = assemble(model, model::TurningParts::apart).stiffness;
  return 0.5 * (k + SparseMatrix(k.transpose()));
}

}  // namespace

double critical_preload_factor(model::Model& model, double up_to) {
  const SparseMatrix whole = symmetric_stiffness(model);
  std::vector<std::vector<double>> before;
  for (const auto& element : model.elements) {
    before.push_back(element->preload());
    if (!before.back().empty()) element->set_preload(std::vector<double>(before.back().size(), 0.0));
  }
  const auto restore = [&] {
    for (std::size_t i = 0; i < before.size(); ++i)
      if (!before[i].empty()) model.elements[i]->set_preload(before[i]);
  };
  SparseMatrix elastic;
  try {
    elastic = symmetric_stiffness(model);
  } catch (...) {
    restore();
    throw;
  }
  restore();

  const SparseMatrix geometric = whole - elastic;
  Eigen::SimplicialLDLT<SparseMatrix> factor;
  factor.analyzePattern(whole);
  const auto holds = [&](double preload) {
    factor.factorize(SparseMatrix(elastic + preload * geometric));
    return factor.info() == Eigen::Success && factor.vectorD().minCoeff() > 0.0;
  };
  if (!holds(0.0)) return std::numeric_limits<double>::quiet_NaN();
  double below = 0.0, above = std::min(1.0, up_to);
  while (holds(above)) {
    if (above >= up_to) return kInfinity;
    below = above;
    above = std::min(2.0 * above, up_to);
  }
  while (above - below > kBisected * above) {
    const double middle = 0.5 * (below + above);
    (holds(middle) ? below : above) = middle;
  }
  return 0.5 * (below + above);
}

}  // namespace butee::dynamics
