#pragma once

#include "butee/model/types.hpp"
#include "elements/beam_matrices.hpp"

namespace butee::elements {

/// The motion of a beam and the effects included.
struct BeamOptions {
  enum class Motion {
    planar,   ///< bends in the plane (x, y): uy, rz
    lateral,  ///< bends in two planes: uy, rz, uz, ry
    spatial   ///< all six DOFs, axial and torsion too
  };
  Motion motion = Motion::planar;
  BeamTheory theory = BeamTheory::euler;
  double preload = 0.0;             ///< N, tension positive: the initial axial force
  bool preload_of_gravity = false;  ///< instead, take the axial forces of the static position under gravity, set later
  /// Columns: the beam's own axes x, y and z in space. For planar and lateral beams they are the
  /// axes of space.
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
};

/// A straight beam of two-node elements with cubic shape functions and consistent mass; see BendingMatrices for
/// bending. Axial and torsional motion have linear shape functions, polar inertia rho (Iy + Iz).
///
/// In the plane (x, z) theta is -ry. Frequencies are too high by O(l^4) without shear, and by
/// O(l^2) with shear and in axial and torsional motion. For a turning round shaft with rotary
/// inertia, G = 2 M_r couples the planes, so that the frequency of forward whirl (in the sense of
/// the rotation) rises with the speed. Checked against closed forms in tests/unit/beam_test.cpp and
/// tests/verification/beam_modes_test.cpp.
class Beam final : public model::Element {
 public:
  /// `nodes` along the beam at ascending `coordinates`, m. The section and the material must define
  /// the data that `options` need.
  Beam(model::Material material, model::Section section, std::vector<model::NodeId> nodes,
       std::vector<double> coordinates, BeamOptions options = {});

  void claim(model::DofTable& dofs) const override;
  void assemble(model::MatrixSink& sink) const override;
  bool add_line_load(std::vector<model::NodalValue>& loads, DofKind along) const override;
  std::vector<model::NodeId> axis() const override { return nodes_; }
  /// p at the end of a part in the beam's own axes, or -p at its beginning.
  std::optional<model::SectionCut> cut(Index part, bool at_end) const override;
  std::vector<double> preload() const override;
  void set_preload(std::vector<double> forces) override { preloads_ = std::move(forces); }
  bool takes_preload_of_gravity() const override { return options_.preload_of_gravity; }
  Turning turning() const override;
  std::string turning_problem() const override;

 private:
  double length_of(Index part) const;
  std::vector<DofKind> kinds() const;
  std::vector<model::NodalDof> dofs_of(Index part) const;
  /// The data that determine the matrices of a part.
  struct Part {
    double length, preload;
    bool operator==(const Part&) const = default;
  };
  Part part_at(Index part) const {
    return {length_of(part), preloads_.empty() ? options_.preload : preloads_[static_cast<std::size_t>(part)]};
  }
  /// Returns the properties of a part of length l, m, with the axial force `preload`, N, in one plane of bending.
  BendingProperties properties(double l, double preload, bool in_xy) const;
  BendingMatrices bending(const Part& part, bool in_xy) const;
  /// Mass, stiffness and, if the beam turns, gyroscopic matrix of a part on the DOFs of dofs_of().
  model::ElementMatrices matrices_of(const Part& part, bool turns) const;
  /// Consistent nodal forces of a line load in N/m on an element of length l.
  Eigen::VectorXd line_load(double l, const Eigen::Vector3d& in_space) const;
  void assemble_planar(model::MatrixSink& sink) const;
  void add_parts(model::MatrixSink& sink, const std::vector<std::vector<DofKind>>& sets, bool turns) const;
  bool is_along_axes() const;

  model::Material material_;
  model::Section section_;
  std::vector<model::NodeId> nodes_;
  std::vector<double> coordinates_;
  /// The length of each part if they are equal, so that the sums of equal stiffnesses have no rounding: in a mesh of n
  /// elements it would count n^4 times. 0 if they are not.
  double even_length_ = 0.0;
  /// The least length of the parts if they are moderately uneven: their stiffnesses are rounded alike, to the same end.
  /// 0 if they are not.
  double shortest_ = 0.0;
  BeamOptions options_;
  std::vector<double> preloads_;  ///< of the parts; empty: the preload of the options
};

model::ElementType beam_type();

}  // namespace butee::elements
