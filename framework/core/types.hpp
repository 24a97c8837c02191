#pragma once

#include <cstdint>

#include <Eigen/Core>
#include <Eigen/SparseCore>

namespace butee {

using Index = Eigen::Index;
using Vector = Eigen::VectorXd;
using VectorRef = Eigen::Ref<Vector>;
using ConstVectorRef = const Eigen::Ref<const Vector>&;
using SparseMatrix = Eigen::SparseMatrix<double>;

/// The two degrees of freedom that a node of a planar beam can have.
enum class DofKind : std::uint8_t {
  u,     ///< transverse displacement, m
  theta  ///< rotation, rad
};

constexpr const char* name_of(DofKind kind) {
  return kind == DofKind::u ? "u" : "theta";
}

}  // namespace butee
