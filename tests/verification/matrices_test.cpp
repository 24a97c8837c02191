#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include <butee/dynamics/modes.hpp>
#include <butee/dynamics/whirl.hpp>
#include <gtest/gtest.h>

#include "support/matrix_files.hpp"
#include "support/program.hpp"
#include "support/scene_run.hpp"

namespace butee::test::matrices_test {
namespace {

/// Rounding of matrices printed with 17 digits and summed in another order.
constexpr double kRounding = 1e-9;

constexpr const char* kHead = R"(
schema = 1
[material.steel]
young_modulus = 2.1e11
density       = 7800.0
[section.pipe]
shape        = "tube"
outer_radius = 0.06
inner_radius = 0.04
)";

std::string beam(const std::string& name, double length, int elements, const std::string& more = "") {
  return "[[element]]\ntype = \"beam\"\nname = \"" + name +
         "\"\nmaterial = \"steel\"\nsection = \"pipe\"\nlength = " + std::to_string(length) +
         "\nelements = " + std::to_string(elements) + "\n" + more;
}

Vector frequencies(const std::string& toml, Index count) {
  SceneRun run(toml);
  const auto modes = dynamics::find_modes(dynamics::Structure(run.model(), run.system().dofs), count);
  EXPECT_EQ(modes.problem, "");
  return modes.frequencies;
}

class MatricesOfABeam : public testing::Test {
 protected:
  /// Writes the matrices of a part to files and returns the keys that refer to them.
  std::string exported(const std::string& toml) {
    SceneRun part(toml);
    folder_.write("m.mtx", matrix_market(part.system().mass, "symmetric"));
    folder_.write("k.mtx", matrix_market(part.system().stiffness, "general"));
    return "mass = \"" + folder_.file("m.mtx") + "\"\nstiffness = \"" + folder_.file("k.mtx") + "\"\n";
  }

  TemporaryFolder folder_;
};

const std::string kRun =
    "[[support]]\nnodes = [\"string:first\", \"END\"]\nfix = [\"u\"]\n[[contact]]\ntype = \"stop\"\nnodes = "
    "\"MIDDLE\"\ngap = 0.001\nlaw = \"linear\"\nstiffness = 1e6\n[[load]]\ntype = \"harmonic\"\nnode = "
    "\"string:1\"\namplitude = 3000.0\nangular_frequency = 30.0\n[damping]\nmass_proportional = "
    "0.1\nstiffness_proportional = 1e-4\n[integrator]\ntype = \"newmark\"\ntime_step = 1e-3\nend_time = 0.3\n";

std::string run_of(const std::string& middle, const std::string& end) {
  std::string text = kRun;
  text.replace(text.find("END"), 3, end);
  text.replace(text.find("MIDDLE"), 6, middle);
  return text;
}

/// Half of a beam is given by its matrices and shares its first node with an ordinary beam: modes and motion
/// equal those of the whole beam.
TEST_F(MatricesOfABeam, AreJoinedToABeamAtASharedNode) {
  const std::string whole = kHead + beam("string", 10.0, 8) + run_of("string:6", "string:last");
  const std::string keys = exported(kHead + beam("half", 5.0, 4) +
                                    "[integrator]\ntype = \"newmark\"\ntime_step = "
                                    "1e-3\nend_time = 1e-3\n");
  const std::string nodes =
      "nodes = [\"string:last\", \"half:0..3\"]\ndofs = [\"u\", \"theta\"]\ncoordinates = [6.25, 7.5, 8.75, 10.0]\n";
  const std::string parts = kHead + beam("string", 5.0, 4) + "[[element]]\ntype = \"matrices\"\nname = \"half\"\n" +
                            keys + nodes + run_of("half:1", "half:last");
  const Vector expected = frequencies(whole, 8), found = frequencies(parts, 8);
  for (Index i = 0; i < 8; ++i) EXPECT_NEAR(found[i], expected[i], kRounding * expected[i]) << i;

  SceneRun one(whole), two(parts);
  Sampler of_one(one.dof("string:6"), {0.1, 0.2, 0.3}), of_two(two.dof("half:1"), {0.1, 0.2, 0.3});
  one.simulation().add(of_one);
  two.simulation().add(of_two);
  ASSERT_TRUE(one.run().completed);
  ASSERT_TRUE(two.run().completed);
  EXPECT_GT(std::abs(of_one.x[2]), 1e-3);
  EXPECT_LT(relative_rms(of_two.x, of_one.x), 1e-8);
}

/// A file may name the rows in any order of the matrices, and all nodes may belong to the element.
TEST_F(MatricesOfABeam, TakeTheirRowsFromAFile) {
  const std::string pinned = kHead + beam("string", 10.0, 8) +
                             "[[support]]\nnodes = [\"string:first\", \"string:last\"]\nfix = [\"u\"]\n" +
                             "[integrator]\ntype = \"newmark\"\ntime_step = 1e-3\nend_time = 1e-3\n";
  SceneRun part(pinned);
  std::string rows = dof_rows(part.system(), part.model().nodes);
  for (std::size_t at = 0; (at = rows.find("string:", at)) != std::string::npos;) rows.erase(at, 7);
  folder_.write("rows.txt", rows);
  const std::string keys = exported(pinned);
  const std::string alone = std::string("schema = 1\n[[element]]\ntype = \"matrices\"\nname = \"all\"\n") + keys +
                            "dofs = \"" + folder_.file("rows.txt") + "\"\n" +
                            "[integrator]\ntype = \"newmark\"\ntime_step = 1e-3\nend_time = 1e-3\n";
  EXPECT_EQ(SceneRun(alone).dof("all:0"), model::DofTable::kAbsent);
  const Vector expected = frequencies(pinned, 8), found = frequencies(alone, 8);
  for (Index i = 0; i < 8; ++i) EXPECT_NEAR(found[i], expected[i], kRounding * expected[i]) << i;
}

/// A rotating shaft given by M, K and G: whirl modes, also with rotating damping, equal those of the shaft.
TEST_F(MatricesOfABeam, TurnWithTheirGyroscopicMatrix) {
  const std::string disc =
      "[[element]]\ntype = \"disc\"\nnode = \"NAME:3\"\nmass = 10.0\ndiametral_inertia = "
      "0.2\npolar_inertia = 0.39\n";
  const std::string rest =
      "[[support]]\nnodes = [\"NAME:0\", \"NAME:6\"]\nfix = [\"uy\", \"uz\"]\n[damping]\n"
      "rotating_stiffness_proportional = 1e-5\n[rotation]\nspeed = 300.0\n[integrator]\ntype = "
      "\"rk4\"\ntime_step = 1e-6\nend_time = 1e-3\n";
  const auto named = [](std::string text, const std::string& name) {
    for (std::size_t at = 0; (at = text.find("NAME", at)) != std::string::npos;) text.replace(at, 4, name);
    return text;
  };
  const std::string shaft = kHead + beam("shaft", 1.5, 6, "motion = \"lateral\"\ntheory = \"rayleigh\"\n");
  SceneRun bare(shaft + "[rotation]\nspeed = 1.0\n[integrator]\ntype = \"rk4\"\ntime_step = 1e-6\nend_time = 1e-3\n");
  const model::System apart = assemble(bare.model(), model::TurningParts::apart);
  folder_.write("m.mtx", matrix_market(apart.mass, "symmetric"));
  folder_.write("k.mtx", matrix_market(apart.stiffness, "symmetric"));
  folder_.write("g.mtx", matrix_market(apart.gyroscopic, "skew-symmetric"));
  const std::string matrices = "[[element]]\ntype = \"matrices\"\nname = \"rotor\"\nmass = \"" + folder_.file("m.mtx") +
                               "\"\nstiffness = \"" + folder_.file("k.mtx") + "\"\ngyroscopic = \"" +
                               folder_.file("g.mtx") + "\"\ndofs = [\"uy\", \"uz\", \"ry\", \"rz\"]\n";
  SceneRun one(shaft + named(disc + rest, "shaft"));
  SceneRun two(std::string("schema = 1\n") + matrices + named(disc + rest, "rotor"));
  EXPECT_EQ(two.model().nodes.size(), 7);
  const auto expected = dynamics::Whirl(one.model()).modes(300.0, 8),
             found = dynamics::Whirl(two.model()).modes(300.0, 8);
  for (std::size_t i = 0; i < 8; ++i)
    EXPECT_LT(std::abs(found[i].lambda - expected[i].lambda), kRounding * std::abs(expected[7].lambda)) << i;
  EXPECT_GT(std::abs(expected[0].lambda.imag() - expected[1].lambda.imag()), 1e-3);
}

/// M and K of a membrane of 7 x 21 points as Kronecker products of bars with consistent masses, computed here
/// entry by entry: lambda = lambda_i + lambda_j with lambda_i = 6/h^2 (1 - cos)/(2 + cos) along each side.
/// Frequencies and the motion under a step force must equal the closed form.
class Membrane : public testing::Test {
 protected:
  static constexpr int kRows = 7, kColumns = 21;

  struct Side {
    int points;
    double spacing;
    double mass(int i, int j) const { return spacing / 6.0 * (i == j ? 4.0 : 1.0); }
    double stiffness(int i, int j) const { return (i == j ? 2.0 : -1.0) / spacing; }
    double cosine(int mode) const { return std::cos(mode * std::numbers::pi / (points + 1)); }
    double lambda(int mode) const { return 6.0 / (spacing * spacing) * (1.0 - cosine(mode)) / (2.0 + cosine(mode)); }
    double shape(int mode, int point) const { return std::sin(mode * std::numbers::pi * (point + 1) / (points + 1)); }
    double modal_mass(int mode) const { return spacing / 6.0 * (4.0 + 2.0 * cosine(mode)) * 0.5 * (points + 1); }
  };
  const Side down_{kRows, 0.31}, along_{kColumns, 0.017};

  /// The lower triangle in the format "coordinate real symmetric".
  std::string file(bool is_mass) const {
    std::string entries;
    int count = 0;
    for (int p = 0; p < kRows * kColumns; ++p)
      for (int q = 0; q <= p; ++q) {
        const int i = p / kColumns, j = q / kColumns, k = p % kColumns, l = q % kColumns;
        if (std::abs(i - j) > 1 || std::abs(k - l) > 1) continue;
        const double value =
            is_mass ? down_.mass(i, j) * along_.mass(k, l)
                    : down_.stiffness(i, j) * along_.mass(k, l) + down_.mass(i, j) * along_.stiffness(k, l);
        char line[80];
        std::snprintf(line, sizeof line, "%d %d %.17g\n", p + 1, q + 1, value);
        entries += line;
        ++count;
      }
    return "%%MatrixMarket matrix coordinate real symmetric\n147 147 " + std::to_string(count) + "\n" + entries;
  }

  std::string scene(const std::string& rest) const {
    folder_.write("m.mtx", file(true));
    folder_.write("k.mtx", file(false));
    return "schema = 1\n[[element]]\ntype = \"matrices\"\nname = \"net\"\nmass = \"" + folder_.file("m.mtx") +
           "\"\nstiffness = \"" + folder_.file("k.mtx") + "\"\ndofs = \"u\"\n" + rest;
  }

  TemporaryFolder folder_;
};

TEST_F(Membrane, HasTheFrequenciesOfItsClosedForm) {
  const std::string toml = scene("[integrator]\ntype = \"exact\"\nend_time = 1.0\n");
  std::vector<double> expected;
  for (int i = 1; i <= kRows; ++i)
    for (int j = 1; j <= kColumns; ++j) expected.push_back(std::sqrt(down_.lambda(i) + along_.lambda(j)));
  std::sort(expected.begin(), expected.end());
  const Vector found = frequencies(toml, kRows * kColumns);
  ASSERT_EQ(found.size(), kRows * kColumns);
  for (Index i = 0; i < found.size(); ++i) {
    const double omega = expected[static_cast<std::size_t>(i)];
    EXPECT_NEAR(found[i], omega, 1e-11 * omega) << i;
  }
  // Both triangles count: the sums of all entries equal those of the products.
  SceneRun run(toml);
  const auto sum = [](const Side& side, bool is_mass) {
    double total = 0.0;
    for (int i = 0; i < side.points; ++i)
      for (int j = std::max(0, i - 1); j < std::min(side.points, i + 2); ++j)
        total += is_mass ? side.mass(i, j) : side.stiffness(i, j);
    return total;
  };
  EXPECT_NEAR(run.system().mass.sum(), sum(down_, true) * sum(along_, true), 1e-12);
  EXPECT_NEAR(run.system().stiffness.sum(),
              sum(down_, false) * sum(along_, true) + sum(down_, true) * sum(along_, false), 1e-10);
}

TEST_F(Membrane, AnswersAStepOfForceAsItsClosedForm) {
  const int loaded = 40, seen = 71;
  const double end = 0.37;
  double expected = 0.0;
  for (int i = 1; i <= kRows; ++i)
    for (int j = 1; j <= kColumns; ++j) {
      const auto shape = [&](int p) { return down_.shape(i, p / kColumns) * along_.shape(j, p % kColumns); };
      const double square = down_.lambda(i) + along_.lambda(j);
      expected += shape(loaded) * shape(seen) / (down_.modal_mass(i) * along_.modal_mass(j)) *
                  (1.0 - std::cos(std::sqrt(square) * end)) / square;
    }
  for (const char* method : {"exact", "exponential"}) {
    SceneRun run(scene("[[load]]\ntype = \"constant\"\nnode = \"net:40\"\nvalue = 1.0\n[integrator]\ntype = \"") +
                 method + "\"\nend_time = 0.37\n" + (method[2] == 'p' ? "tolerance = 1e-8\n" : ""));
    ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
    EXPECT_NEAR(run.simulation().state().x[run.dof("net:" + std::to_string(seen))], expected, 1e-8 * std::abs(expected))
        << method;
  }
}

/// A matrix C from a file is added to [damping] and need not be symmetric.
TEST_F(MatricesOfABeam, AddTheirDamping) {
  folder_.write("m.mtx", "%%MatrixMarket matrix array real symmetric\n2 2\n2.0\n0\n3.0\n");
  folder_.write("k.mtx", "%%MatrixMarket matrix array real symmetric\n2 2\n200.0\n-50\n300.0\n");
  folder_.write("c.mtx", "%%MatrixMarket matrix array real general\n2 2\n1.0\n0.25\n-0.5\n2.0\n");
  SceneRun run("schema = 1\n[[element]]\ntype = \"matrices\"\nname = \"two\"\nmass = \"" + folder_.file("m.mtx") +
               "\"\nstiffness = \"" + folder_.file("k.mtx") + "\"\ndamping = \"" + folder_.file("c.mtx") +
               "\"\ndofs = \"u\"\n[damping]\nmass_proportional = 0.5\n[integrator]\ntype = \"rk4\"\ntime_step = "
               "1e-3\nend_time = 1e-2\n");
  Eigen::Matrix2d damping;
  damping << 1.0, -0.5, 0.25, 2.0;
  EXPECT_EQ(Eigen::MatrixXd(run.system().dashpots), damping);
  EXPECT_FALSE(run.system().is_symmetric);
  EXPECT_TRUE(run.system().stiffness_is_symmetric);
}

}  // namespace
}  // namespace butee::test::matrices_test
