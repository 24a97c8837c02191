#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Dense>
#include <butee/core/text.hpp>
#include <butee/linalg/dense_pairs.hpp>

#include "apps/conformance/bench.hpp"

namespace butee::conformance {
namespace {

/// The elements before the one under test.
constexpr std::size_t kOthers = 4;

/// A beam, two masses on springs, and the element under test.
std::string scene(const Subject& subject) {
  std::string text =
      "schema = 1\n[material.steel]\nyoung_modulus = 2e11\ndensity = 7900\n[section.pipe]\nshape = \"circle\"\nradius "
      "= 0.02\n"
      "[[element]]\ntype = \"beam\"\nname = \"string\"\nmaterial = \"steel\"\nsection = \"pipe\"\nlength = "
      "4.0\nelements = 4\n"
      "[[element]]\ntype = \"mass\"\nname = \"a\"\nmass = 2.0\n[[element]]\ntype = \"mass\"\nname = \"b\"\nmass = 1.0\n"
      "[[element]]\ntype = \"spring\"\nnodes = [\"a\", \"b\"]\nstiffness = 500.0\n[[element]]\ntype = \"";
  text += subject.name + "\"\n" + subject.keys;
  text +=
      "[[support]]\nnodes = [\"string:first\", \"string:last\"]\nfix = [\"u\"]\n"
      "[initial]\nvelocity = [{nodes = \"string:2\", value = 0.1}, {nodes = \"a\", value = 0.1}]\n";
  return text;
}

/// The matrices of one element alone.
class Alone final : public model::MatrixSink {
 public:
  void add(std::span<const model::NodalDof> dofs, const model::ElementMatrices& matrices) override {
    std::vector<Index> places;
    for (const model::NodalDof& dof : dofs) {
      const auto found = std::find_if(dofs_.begin(), dofs_.end(), [&](const model::NodalDof& known) {
        return known.node == dof.node && known.kind == dof.kind;
      });
      places.push_back(found - dofs_.begin());
      if (found == dofs_.end()) dofs_.push_back(dof);
    }
    const auto n = static_cast<Index>(dofs_.size());
    for (Eigen::MatrixXd* matrix : {&mass, &damping, &stiffness})
      matrix->conservativeResizeLike(Eigen::MatrixXd::Zero(n, n));
    mass(places, places) += matrices.mass;
    damping(places, places) += matrices.damping;
    stiffness(places, places) += matrices.stiffness;
  }

  Eigen::MatrixXd mass{}, damping{}, stiffness{};

 private:
  std::vector<model::NodalDof> dofs_;
};

/// Stiffness and damping need not be symmetric, for example those of a bearing; only the symmetric part is
/// checked for definiteness.
std::string complaint(const std::string& name, Eigen::MatrixXd matrix, bool may_be_skew = true) {
  if (matrix.size() == 0) return "";
  if (!matrix.allFinite()) return name + " is not finite";
  // Tolerances for asymmetry of summed contributions, and for the zero eigenvalues of a semi-definite matrix.
  constexpr double kRounding = 1e-12;
  const double scale = matrix.cwiseAbs().maxCoeff();
  if (!may_be_skew && (matrix - matrix.transpose()).cwiseAbs().maxCoeff() > kRounding * scale)
    return name + " is not symmetric";
  matrix = (0.5 * (matrix + matrix.transpose())).eval();
  const auto pairs = linalg::dense_pairs(matrix);
  if (!pairs) return name + " has no eigenvalues";
  const double lowest = pairs->values[0];
  if (lowest < -1e3 * kRounding * scale)
    return name + " is indefinite: its lowest eigenvalue is " + to_short_text(lowest);
  return "";
}

Finding check_matrices(const Subject& subject) {
  Bench bench(subject.catalogue, scene(subject) + integrator_table("rk4", "", 1e-6, 1e-3));
  const model::System& system = bench.system();
  // Beside a heavy structure the element's own part could be lost.
  Alone alone;
  system.model->elements.at(kOthers)->assemble(alone);
  for (const auto& found :
       {complaint("its mass matrix", alone.mass, false), complaint("its stiffness matrix", alone.stiffness),
        complaint("its damping matrix", alone.damping),
        complaint("the mass matrix", Eigen::MatrixXd(system.mass), false),
        complaint("the stiffness matrix", Eigen::MatrixXd(system.stiffness)),
        complaint("the damping matrix", Eigen::MatrixXd(system.dashpots))})
    if (!found.empty()) return {false, found};
  return {true, std::string(system.is_symmetric ? "symmetric" : "not symmetric") + " and not negative, " +
                    std::to_string(system.size()) + " free DOFs"};
}

/// Without loads and stops, the energy must not increase.
Finding check_free_motion(const Subject& subject) {
  Bench bench(subject.catalogue, scene(subject) + integrator_table("rodas4", "tolerance = 1e-6\n", 1e-5, 0.2));
  const auto energy = [&](const time::State& state) {
    return 0.5 * state.v.dot(bench.system().mass * state.v) + 0.5 * state.x.dot(bench.system().stiffness * state.x);
  };
  const double before = energy(bench.initial_state());
  if (!bench.simulation().run().completed) return {false, bench.simulation().report().message};
  const double after = energy(bench.simulation().state());
  return {after <= before * (1.0 + 1e-3),
          "free motion keeps " + to_short_text(100.0 * after / before) + " % of its energy over 0.2 s"};
}

}  // namespace

std::vector<Check> element_checks() {
  return {{"matrices", "mass, damping and stiffness are not negative, the mass is symmetric", check_matrices},
          {"motion", "free motion gains no energy", check_free_motion}};
}

}  // namespace butee::conformance
