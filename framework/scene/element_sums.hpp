#pragma once

#include <map>
#include <string>
#include <vector>

#include "butee/model/element.hpp"

namespace butee::scene {

/// Sums the contributions of elements to the diagonals of the matrices, DOF by DOF. Private to the framework.
class ElementSums final : public model::MatrixSink {
 public:
  struct Contribution {
    double value = 0.0;
    std::size_t element = 0;
  };
  /// The sums of one free DOF in kg, N/m and N s/m, or kg m2, N m/rad and N m s/rad.
  struct Sum {
    double mass = 0.0, stiffness = 0.0, damping = 0.0;
    Contribution stiffest, softest, most_damped;  ///< the softest of those above 0 that are not rounding of their part
  };

  /// `dofs` must outlive this object and be numbered.
  explicit ElementSums(const model::DofTable& dofs);

  /// The contributions that follow are those of this element.
  void begin_element(std::size_t element) { element_ = element; }
  void add(std::span<const model::NodalDof> dofs, const model::ElementMatrices& matrices) override;

  /// Returns the sums of all free DOFs, in the order of DofTable::free().
  const std::vector<Sum>& sums() const { return sums_; }
  /// Returns why elements cannot be assembled, by their numbers.
  const std::map<std::size_t, std::string>& complaints() const { return complaints_; }

 private:
  const model::DofTable& dofs_;
  std::vector<Sum> sums_;
  std::map<std::size_t, std::string> complaints_;
  std::size_t element_ = 0;
};

}  // namespace butee::scene
