#include "elements/beam.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace butee::elements {

using model::NodalDof;
using model::NodeId;
using Motion = BeamOptions::Motion;

namespace {

constexpr std::array<DofKind, 2> kPlaneY = {DofKind::uy, DofKind::rz}, kPlaneZ = {DofKind::uz, DofKind::ry};

/// The largest ratio of the lengths of parts whose stiffnesses are rounded alike: the softest then changes by 1e-12.
constexpr double kMostUneven = 10.0;

/// Rounds the forces of displacements and of rotations to multiples of one number each, 2^-50 of those of the stiffest
/// part, so that sums of those of neighbours have no rounding.
void round_alike(const Eigen::Matrix4d& stiffest, Eigen::Matrix4d& stiffness) {
  for (Index j = 0; j < 4; ++j)
    for (Index i = 0; i < 4; ++i) {
      const double largest = std::abs(stiffest(i % 2, j % 2));
      const bool is_of_rotations = i % 2 == 1 && j % 2 == 1;  // their sums lose n^2 epsilon only
      if (is_of_rotations || !(largest > 0.0) || !std::isfinite(largest)) continue;
      const double above = std::ldexp(6.0, std::ilogb(largest));
      stiffness(i, j) = (stiffness(i, j) + above) - above;
    }
}

/// The indices, among the DOFs of a part, of the DOFs of one plane of bending, of axial motion or
/// of torsion.
std::vector<Index> places_of(const std::vector<DofKind>& kinds, std::span<const DofKind> wanted) {
  std::vector<Index> places;
  for (Index node = 0; node < 2; ++node)
    for (const DofKind kind : wanted)
      places.push_back(node * std::ssize(kinds) + (std::find(kinds.begin(), kinds.end(), kind) - kinds.begin()));
  return places;
}

/// Converts a matrix on (u1, theta1, u2, theta2) of the plane (x, z), theta = -ry, to (uz1, ry1,
/// uz2, ry2).
Eigen::Matrix4d with_ry(const Eigen::Matrix4d& matrix) {
  const Eigen::Vector4d sign(1, -1, 1, -1);
  return sign.asDiagonal() * matrix * sign.asDiagonal();
}

void add_at(const std::vector<Index>& rows, const std::vector<Index>& columns, const Eigen::MatrixXd& block,
            Eigen::MatrixXd& matrix) {
  matrix(rows, columns) += block;
}

model::ElementMatrices selected(const model::ElementMatrices& whole, const std::vector<Index>& places) {
  model::ElementMatrices part(std::ssize(places));
  part.mass = whole.mass(places, places);
  part.stiffness = whole.stiffness(places, places);
  if (whole.gyroscopic.size() > 0) part.gyroscopic = whole.gyroscopic(places, places);
  return part;
}

/// The shear ratio Phi, or 0 without shear.
double shear_ratio(const BeamOptions& options, const model::Material& material, double bending_stiffness, double area,
                   const model::ShearFactor& factor, double l) {
  if (options.theory != BeamTheory::timoshenko) return 0.0;
  return 12.0 * bending_stiffness / (factor.at(material.poisson_ratio()) * material.shear_modulus * area * l * l);
}

}  // namespace

Beam::Beam(model::Material material, model::Section section, std::vector<NodeId> nodes, std::vector<double> coordinates,
           BeamOptions options)
    : material_(material),
      section_(section),
      nodes_(std::move(nodes)),
      coordinates_(std::move(coordinates)),
      options_(std::move(options)) {
  const double first = coordinates_.front(), last = coordinates_.back();
  const double mean = (last - first) / static_cast<double>(coordinates_.size() - 1);
  const double rounding = 4.0 * std::numeric_limits<double>::epsilon() * std::max(std::abs(first), std::abs(last));
  const auto uneven = std::adjacent_find(coordinates_.begin(), coordinates_.end(),
                                         [&](double a, double b) { return std::abs(b - a - mean) > rounding; });
  if (uneven == coordinates_.end()) {
    even_length_ = mean;
    return;
  }
  double least = std::numeric_limits<double>::infinity(), most = 0.0;
  for (Index e = 0; e + 1 < std::ssize(coordinates_); ++e) {
    least = std::min(least, length_of(e));
    most = std::max(most, length_of(e));
  }
  if (most <= kMostUneven * least) shortest_ = least;
}

bool Beam::is_along_axes() const {
  return options_.axes.isIdentity(0.0);
}

std::vector<DofKind> Beam::kinds() const {
  switch (options_.motion) {
    case Motion::planar:
      return {DofKind::uy, DofKind::rz};
    case Motion::lateral:
      return {DofKind::uy, DofKind::uz, DofKind::ry, DofKind::rz};
    case Motion::spatial:
      break;
  }
  return {kAllDofKinds.begin(), kAllDofKinds.end()};
}

std::vector<NodalDof> Beam::dofs_of(Index part) const {
  const auto e = static_cast<std::size_t>(part);
  std::vector<NodalDof> dofs;
  for (const NodeId node : {nodes_[e], nodes_[e + 1]})
    for (const DofKind kind : kinds()) dofs.push_back({node, kind});
  return dofs;
}

void Beam::claim(model::DofTable& dofs) const {
  const auto kinds = this->kinds();
  for (const NodeId node : nodes_)
    for (const DofKind kind : kinds) dofs.claim({node, kind}, true);
}

BendingProperties Beam::properties(double l, double preload, bool in_xy) const {
  const double moment = in_xy ? section_.second_moment : section_.second_moment_y;
  const double stiffness = material_.young_modulus * moment;
  const auto& factor = in_xy ? section_.shear_factor_y : section_.shear_factor_z;
  return {l,
          stiffness,
          material_.density * section_.area,
          options_.theory == BeamTheory::euler ? 0.0 : material_.density * moment,
          shear_ratio(options_, material_, stiffness, section_.area, factor, l),
          preload};
}

BendingMatrices Beam::bending(const Part& part, bool in_xy) const {
  BendingMatrices matrices(properties(part.length, part.preload, in_xy));
  if (shortest_ > 0.0)
    round_alike(BendingMatrices(properties(shortest_, part.preload, in_xy)).stiffness, matrices.stiffness);
  return matrices;
}

model::ElementMatrices Beam::matrices_of(const Part& part, bool turns) const {
  const double l = part.length;
  const auto kinds = this->kinds();
  model::ElementMatrices matrices(2 * std::ssize(kinds));
  const BendingMatrices in_xy = bending(part, true);
  const auto y = places_of(kinds, kPlaneY);
  add_at(y, y, in_xy.mass, matrices.mass);
  add_at(y, y, in_xy.stiffness, matrices.stiffness);
  if (options_.motion == Motion::planar) return matrices;
  const BendingMatrices in_xz = bending(part, false);
  const auto z = places_of(kinds, kPlaneZ);
  add_at(z, z, with_ry(in_xz.mass), matrices.mass);
  add_at(z, z, with_ry(in_xz.stiffness), matrices.stiffness);
  if (turns) {
    // In plane y: + Omega G times the rates theta' of plane z; in plane z: - Omega G times those of
    // plane y.
    const Eigen::Matrix4d gyroscopic = in_xy.rotary + in_xz.rotary;
    const Eigen::DiagonalMatrix<double, 4> sign(1, -1, 1, -1);
    matrices.gyroscopic = Eigen::MatrixXd::Zero(matrices.mass.rows(), matrices.mass.cols());
    add_at(y, z, gyroscopic * sign, matrices.gyroscopic);
    add_at(z, y, -(sign * gyroscopic), matrices.gyroscopic);
  }
  if (options_.motion == Motion::lateral) return matrices;
  Eigen::Matrix2d bar, rod;
  bar << 1, -1, -1, 1;
  rod << 2, 1, 1, 2;
  const auto x = places_of(kinds, std::array{DofKind::ux}), twist = places_of(kinds, std::array{DofKind::rx});
  add_at(x, x, material_.young_modulus * section_.area / l * bar, matrices.stiffness);
  add_at(x, x, material_.density * section_.area * l / 6.0 * rod, matrices.mass);
  add_at(twist, twist, material_.shear_modulus * section_.torsion_constant / l * bar, matrices.stiffness);
  add_at(twist, twist, material_.density * (section_.second_moment + section_.second_moment_y) * l / 6.0 * rod,
         matrices.mass);
  if (is_along_axes()) return matrices;
  Eigen::MatrixXd to_space = Eigen::MatrixXd::Zero(12, 12);
  for (Index i = 0; i < 12; i += 3) to_space.block<3, 3>(i, i) = options_.axes;
  for (Eigen::MatrixXd* matrix : {&matrices.mass, &matrices.stiffness}) {
    *matrix = (to_space * *matrix * to_space.transpose()).eval();
    *matrix = (0.5 * (*matrix + matrix->transpose())).eval();
  }
  return matrices;
}

void Beam::assemble_planar(model::MatrixSink& sink) const {
  std::optional<Part> before;
  model::ElementMatrices matrices(4);
  for (std::size_t e = 0; e + 1 < nodes_.size(); ++e) {
    const Part part = part_at(static_cast<Index>(e));
    if (part != before) {
      const BendingMatrices in_xy = bending(part, true);
      matrices.mass = in_xy.mass;
      matrices.stiffness = in_xy.stiffness;
    }
    before = part;
    const std::array<NodalDof, 4> dofs = {NodalDof{nodes_[e], DofKind::uy}, NodalDof{nodes_[e], DofKind::rz},
                                          NodalDof{nodes_[e + 1], DofKind::uy}, NodalDof{nodes_[e + 1], DofKind::rz}};
    sink.add(dofs, matrices);
  }
}

void Beam::assemble(model::MatrixSink& sink) const {
  if (options_.motion == Motion::planar) return assemble_planar(sink);
  // Uncoupled DOFs are added separately, so that the matrix pattern shows it.
  std::vector<std::vector<DofKind>> sets;
  if (!is_along_axes()) {
    sets = {kinds()};
  } else {
    if (sink.turns())
      sets = {{DofKind::uy, DofKind::uz, DofKind::ry, DofKind::rz}};
    else
      sets = {{kPlaneY.begin(), kPlaneY.end()}, {kPlaneZ.begin(), kPlaneZ.end()}};
    if (options_.motion == Motion::spatial) sets.insert(sets.end(), {{DofKind::ux}, {DofKind::rx}});
  }
  add_parts(sink, sets, sink.turns());
}

void Beam::add_parts(model::MatrixSink& sink, const std::vector<std::vector<DofKind>>& sets, bool turns) const {
  const auto kinds = this->kinds();
  std::optional<Part> before;
  std::vector<model::ElementMatrices> matrices;
  std::vector<NodalDof> dofs;
  for (std::size_t e = 0; e + 1 < nodes_.size(); ++e) {
    const Part part = part_at(static_cast<Index>(e));
    if (part != before) {
      matrices.clear();
      const model::ElementMatrices whole = matrices_of(part, turns);
      for (const auto& set : sets)
        matrices.push_back(set.size() == kinds.size() ? whole : selected(whole, places_of(kinds, set)));
    }
    before = part;
    for (std::size_t i = 0; i < sets.size(); ++i) {
      dofs.clear();
      for (const NodeId node : {nodes_[e], nodes_[e + 1]})
        for (const DofKind kind : sets[i]) dofs.push_back({node, kind});
      sink.add(dofs, matrices[i]);
    }
  }
}

double Beam::length_of(Index part) const {
  if (even_length_ > 0.0) return even_length_;
  const auto e = static_cast<std::size_t>(part);
  return coordinates_.at(e + 1) - coordinates_.at(e);
}

Eigen::VectorXd Beam::line_load(double l, const Eigen::Vector3d& in_space) const {
  const auto kinds = this->kinds();
  const Eigen::Vector3d q = options_.axes.transpose() * in_space;
  Eigen::VectorXd load(2 * std::ssize(kinds));
  for (Index node = 0; node < 2; ++node) {
    const double couple = (node == 0 ? 1.0 : -1.0) * l * l / 12.0;
    const Eigen::Vector3d force = options_.axes * (0.5 * l * q);
    const Eigen::Vector3d moment = options_.axes * Eigen::Vector3d(0.0, -couple * q[2], couple * q[1]);
    for (std::size_t k = 0; k < kinds.size(); ++k)
      load[node * std::ssize(kinds) + static_cast<Index>(k)] =
          is_rotation(kinds[k]) ? moment[axis_of(kinds[k])] : force[axis_of(kinds[k])];
  }
  return load;
}

bool Beam::add_line_load(std::vector<model::NodalValue>& loads, DofKind along) const {
  const auto kinds = this->kinds();
  if (is_rotation(along) || std::find(kinds.begin(), kinds.end(), along) == kinds.end()) return false;
  for (Index e = 0; e + 1 < std::ssize(nodes_); ++e) {
    const Eigen::VectorXd consistent = line_load(length_of(e), Eigen::Vector3d::Unit(axis_of(along)));
    const auto dofs = dofs_of(e);
    for (std::size_t i = 0; i < dofs.size(); ++i)
      if (const double value = consistent[static_cast<Index>(i)]; value != 0.0) loads.push_back({dofs[i], value});
  }
  return true;
}

std::optional<model::SectionCut> Beam::cut(Index part, bool at_end) const {
  const double l = length_of(part), sign = at_end ? 1.0 : -1.0;
  const auto kinds = this->kinds();
  model::SectionCut cut(dofs_of(part));
  cut.matrices = matrices_of(part_at(part), turning() != Turning::never);
  for (int axis = 0; axis < 3; ++axis) cut.line_loads.col(axis) = line_load(l, Eigen::Vector3d::Unit(axis));
  // Rows of the forces along, and the moments about, the beam's own axes.
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    const Index column = (at_end ? std::ssize(kinds) : 0) + static_cast<Index>(k);
    const int first = is_rotation(kinds[k]) ? 3 : 0;
    cut.resultants.block<3, 1>(first, column) = sign * options_.axes.row(axis_of(kinds[k])).transpose();
  }
  cut.area = section_.area;
  // Under gravity the displacements themselves stretch the beam to its weight.
  if (!options_.preload_of_gravity) cut.preload = part_at(part).preload;
  if (section_.torsion_modulus > 0.0) cut.torsion_modulus = section_.torsion_modulus;
  if (section_.outer_fibre > 0.0) cut.modulus = section_.second_moment / section_.outer_fibre;
  if (section_.outer_fibre_z > 0.0) cut.modulus_y = section_.second_moment_y / section_.outer_fibre_z;
  return cut;
}

std::vector<double> Beam::preload() const {
  std::vector<double> all;
  for (Index part = 0; part + 1 < std::ssize(nodes_); ++part) all.push_back(part_at(part).preload);
  return all;
}

Beam::Turning Beam::turning() const {
  const bool is_along_x = options_.axes.col(0).cwiseAbs() == Eigen::Vector3d::UnitX();
  return options_.motion != Motion::planar && is_along_x ? Turning::possible : Turning::never;
}

std::string Beam::turning_problem() const {
  if (options_.axes(0, 0) < 0.0) return "its points run against x; give them in the order of x";
  const double a = section_.second_moment, b = section_.second_moment_y;
  const auto differ = [](double p, double q) { return std::abs(p - q) > 1e-9 * std::max(p, q); };
  if (differ(a, b))
    return "its second moments of area about y and z differ, so that its stiffness would change as it turns";
  const auto shear = [&](const model::ShearFactor& factor) {
    return shear_ratio(options_, material_, material_.young_modulus * a, section_.area, factor, 1.0);
  };
  if (differ(shear(section_.shear_factor_y), shear(section_.shear_factor_z)))
    return "its shear factors along y and z differ, so that its stiffness would change as it turns";
  return "";
}

}  // namespace butee::elements
