#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include <Eigen/Core>
#include <Eigen/SparseCore>

namespace butee {

using Index = Eigen::Index;
using Vector = Eigen::VectorXd;
using VectorRef = Eigen::Ref<Vector>;
using ConstVectorRef = const Eigen::Ref<const Vector>&;
using SparseMatrix = Eigen::SparseMatrix<double>;

/// The degrees of freedom that a node can have: displacements (m) along x, y and z and rotations (rad) about them,
/// right-handed. A planar beam along x bends in the plane (x, y): u = uy and theta = rz = du/dx.
enum class DofKind : std::uint8_t { ux, uy, uz, rx, ry, rz, u = uy, theta = rz };

inline constexpr int kDofKinds = 6;
inline constexpr std::array<DofKind, kDofKinds> kAllDofKinds = {DofKind::ux, DofKind::uy, DofKind::uz,
                                                                DofKind::rx, DofKind::ry, DofKind::rz};

constexpr bool is_rotation(DofKind kind) {
  return kind >= DofKind::rx;
}
/// 0, 1 or 2: along or about x, y or z.
constexpr int axis_of(DofKind kind) {
  return static_cast<int>(kind) % 3;
}
/// The displacement along, or the rotation about, an axis (0, 1 or 2).
constexpr DofKind displacement_along(int axis) {
  return static_cast<DofKind>(axis);
}
constexpr DofKind rotation_about(int axis) {
  return static_cast<DofKind>(axis + 3);
}
/// "u" and "theta" in the plane, else "ux", "uz", "rx", "ry".
constexpr const char* name_of(DofKind kind) {
  constexpr std::array<const char*, kDofKinds> kNames = {"ux", "u", "uz", "rx", "ry", "theta"};
  return kNames[static_cast<std::size_t>(kind)];
}
/// All names that a scene may use: ux ... rz and the aliases u (uy), w (uz) and theta (rz).
inline constexpr std::array<std::string_view, 9> kDofNames = {"u", "theta", "ux", "uy", "uz", "rx", "ry", "rz", "w"};
/// The kind of a name of kDofNames; nothing for other names.
constexpr std::optional<DofKind> dof_named(std::string_view name) {
  if (name == "u") return DofKind::uy;
  if (name == "w") return DofKind::uz;
  if (name == "theta") return DofKind::rz;
  for (std::size_t i = 2; i < 8; ++i)
    if (kDofNames[i] == name) return kAllDofKinds[i - 2];
  return std::nullopt;
}

}  // namespace butee
