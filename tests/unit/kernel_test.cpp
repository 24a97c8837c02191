// The kernels of framework/linalg and framework/dynamics on every instruction set of this processor, compared
// with plain loops; modules for one instruction set.
#include <cmath>
#include <filesystem>

#include <butee/core/error.hpp>
#include <butee/core/target.hpp>
#include <butee/dynamics/contact_propagator.hpp>
#include <butee/linalg/band_factor.hpp>
#include <butee/linalg/dense_product.hpp>
#include <butee/linalg/force_balance.hpp>
#include <butee/linalg/symmetric_product.hpp>
#include <butee/plugin/module.hpp>
#include <gtest/gtest.h>

#include "support/program.hpp"

namespace butee::test::kernel_test {
namespace {

using Eigen::ArrayXd;
using Eigen::MatrixXd;

/// Sums of up to 100 products of numbers up to 1, in another order and possibly with fused operations.
constexpr double kRounding = 1e-14;

Vector wave(Index size, double phase) {
  Vector x(size);
  for (Index i = 0; i < size; ++i) x[i] = std::sin(phase + 1.7 * static_cast<double>(i));
  return x;
}

MatrixXd waves(Index rows, Index columns) {
  MatrixXd a(rows, columns);
  for (Index j = 0; j < columns; ++j) a.col(j) = wave(rows, 0.3 * static_cast<double>(j));
  return a;
}

/// Runs a test on each instruction set.
class Kernels : public testing::Test {
 protected:
  template <class Check>
  void on_every_target(const Check& check) {
    for (const std::string& name : targets()) {
      SCOPED_TRACE(name);
      choose_target(name);
      check();
      ++targets_;
    }
    EXPECT_EQ(targets_, targets().size());
  }
  ~Kernels() override { choose_target(before_); }

 private:
  std::string before_ = target();
  std::size_t targets_ = 0;
};

TEST_F(Kernels, AnotherNameIsBadInput) {
  EXPECT_THROW(choose_target("mmx"), InputError);
  EXPECT_NO_THROW(choose_target(targets().front()));
}

TEST_F(Kernels, DenseProducts) {
  on_every_target([] {
    for (Index rows = 1; rows <= linalg::DenseProduct::kMostRows; ++rows) {
      const Index columns = 1 + (7 * rows) % 97;
      const MatrixXd a = waves(rows, columns);
      const linalg::DenseProduct product(a);
      const Vector x0 = wave(columns, 0.1), x1 = wave(columns, 0.9);
      // Data beyond the rows must not change.
      Vector y0 = Vector::Constant(rows + 1, 7.0), y1 = y0;
      product.multiply(x0.data(), y0.data());
      EXPECT_LE((y0.head(rows) - a * x0).lpNorm<Eigen::Infinity>(), kRounding * 10.0) << rows;
      y0.head(rows).setZero();
      product.multiply(x0.data(), x1.data(), y0.data(), y1.data());
      EXPECT_LE((y0.head(rows) - a * x0).lpNorm<Eigen::Infinity>(), kRounding * 10.0) << rows;
      EXPECT_LE((y1.head(rows) - a * x1).lpNorm<Eigen::Infinity>(), kRounding * 10.0) << rows;
      const std::vector<Index> chosen = {columns / 3, columns - 1};
      if (columns < 4) continue;
      product.multiply(chosen, x1.data(), y1.data());
      const Vector sum = a.col(chosen[0]) * x1[chosen[0]] + a.col(chosen[1]) * x1[chosen[1]];
      EXPECT_LE((y1.head(rows) - sum).lpNorm<Eigen::Infinity>(), kRounding) << rows;
      EXPECT_TRUE(y0[rows] == 7.0 && y1[rows] == 7.0) << rows;
    }
  });
}

/// `uniform`: rows repeat, so that large matrices share them in storage.
SparseMatrix band_matrix(Index size, Index band, bool uniform) {
  SparseMatrix matrix(size, size);
  std::vector<Eigen::Triplet<double>> entries;
  for (Index i = 0; i < size; ++i)
    for (Index k = 0; k <= band && i + k < size; ++k) {
      const double value = std::sin(static_cast<double>(7 * k + (uniform ? 0 : 3 * i)) + 0.5) + (k == 0 ? 20.0 : 0.0);
      entries.emplace_back(i, i + k, value);
      if (k > 0) entries.emplace_back(i + k, i, value);
    }
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

TEST_F(Kernels, ProductsByDiagonals) {
  on_every_target([] {
    const auto check = [](Index size, Index band, bool uniform) {
      const SparseMatrix matrix = band_matrix(size, band, uniform);
      const linalg::SymmetricProduct product(matrix);
      const Vector x = wave(size, 0.2), expected = matrix * x;
      Vector y = Vector::Constant(size + 1, 7.0);
      product.multiply(x.data(), 0, size, y.data());
      EXPECT_LE((y.head(size) - expected).lpNorm<Eigen::Infinity>(), 20.0 * kRounding) << size << ", band " << band;
      EXPECT_EQ(y[size], 7.0);
      if (size < 2000) return;
      const Index half = 1024, rest = size - half;
      y.head(size).setZero();
      product.multiply(x.data(), 0, half, y.data());
      product.multiply(x.data(), half, rest, y.data() + half);
      EXPECT_LE((y.head(size) - expected).lpNorm<Eigen::Infinity>(), 20.0 * kRounding) << size << " in two blocks";
    };
    for (Index band = 0; band <= 8; ++band)
      for (Index size = band + 1; size <= 67; ++size) check(size, band, false);
    for (const Index size : {2000, 2053, 3001, 3008})
      for (const bool uniform : {false, true}) check(size, 3, uniform);
  });
}

TEST_F(Kernels, SolutionsWithANarrowBand) {
  on_every_target([] {
    for (Index band = 1; band <= linalg::BandFactor::kWidestBand; ++band)
      for (Index size = 3 * band + 1; size <= 3 * band + 20; ++size) {
        const SparseMatrix matrix = band_matrix(size, band, false);
        linalg::BandFactor factor(size, band);
        ASSERT_TRUE(factor.factorize(matrix));
        Vector x = wave(size, 0.4), less = x;
        const Vector right = x, v = wave(size, 0.8);
        factor.solve(x.data());
        EXPECT_LE((matrix * x - right).lpNorm<Eigen::Infinity>(), 20.0 * kRounding) << size << ", band " << band;
        factor.solve_less(less.data(), 3.0, v.data());
        EXPECT_LE((less - (x - 3.0 * v)).lpNorm<Eigen::Infinity>(), kRounding) << size << ", band " << band;
      }
  });
}

TEST_F(Kernels, SumsOfForces) {
  on_every_target([] {
    for (Index count = 1; count <= 40; ++count)
      for (int present = 0; present < 8; ++present) {
        std::vector<Vector> terms;
        for (int k = 0; k < 5; ++k) terms.push_back(wave(count, 0.7 * k));
        const auto given = [&](int bit, std::size_t k) { return (present & bit) != 0 ? terms[k].data() : nullptr; };
        if (given(1, 0) == nullptr) terms[0].setZero();
        if (given(2, 1) == nullptr) terms[1].setZero();
        if (given(4, 3) == nullptr) terms[3].setZero();
        Vector r = Vector::Constant(count + 1, 7.0);
        linalg::ForceBalance balance;
        balance.add({given(1, 0), given(2, 1), terms[2].data(), given(4, 3), terms[4].data()}, count, r.data());
        const Vector expected = terms[0] + terms[1] - terms[2] - terms[3] - terms[4];
        double scale = 0.0;
        for (const Vector& term : terms) scale += term.norm();
        EXPECT_LE((r.head(count) - expected).lpNorm<Eigen::Infinity>(), kRounding) << count;
        EXPECT_EQ(r[count], 7.0) << count;
        EXPECT_NEAR(balance.residual(), expected.norm(), 10.0 * kRounding) << count;
        EXPECT_NEAR(balance.scale(), scale, 10.0 * kRounding) << count;
      }
  });
}

constexpr double kStep = 0.01;

/// Modes of 0 ... n-1 rad/s without damping; the first is rigid.
dynamics::ModalPropagator modes_over(double h, Index count,
                                     const std::vector<dynamics::ModalHarmonic>& harmonics = {}) {
  return {ArrayXd::LinSpaced(count, 0.0, static_cast<double>(count - 1)), ArrayXd::Zero(count), harmonics, h};
}

TEST_F(Kernels, SeriesOfModes) {
  on_every_target([] {
    for (const Index count : {1, 7, 8, 21}) {
      const dynamics::ModalHarmonic load{2.5, ArrayXd::LinSpaced(count, 1.0, 2.0),
                                         ArrayXd::LinSpaced(count, -1.0, 1.0)};
      const dynamics::ModalPropagator flow = modes_over(kStep, count, {load});
      for (Index i = 1; i < count; ++i) {
        const double omega = static_cast<double>(i), angle = omega * kStep, h = kStep;
        EXPECT_NEAR(flow.qq()[i], std::cos(angle), kRounding);
        EXPECT_NEAR(flow.vv()[i], std::cos(angle), kRounding);
        EXPECT_NEAR(flow.qv()[i], std::sin(angle) / omega, kRounding);
        EXPECT_NEAR(flow.vq()[i], -omega * std::sin(angle), kRounding * omega);
        // Response to the forces 1 and 2 t/h - 1.
        const double half = std::sin(0.5 * angle), constant = 2.0 * half * half / (omega * omega);
        EXPECT_NEAR(flow.force_q(0)[i], constant, kRounding * h * h);
        EXPECT_NEAR(flow.force_v(0)[i], std::sin(angle) / omega, kRounding * h);
        // The tolerance allows for cancellation in the closed form.
        const double linear = (1.0 - std::sin(angle) / angle) / (omega * omega);
        EXPECT_NEAR(flow.force_q(1)[i], 2.0 * linear - constant, 1e-15 / (omega * omega));
        // Response of q'' + omega^2 q to cos(Omega t) and to sin(Omega t) from rest.
        const double rate = load.angular_frequency, below = omega * omega - rate * rate;
        const double by_cosine = (std::cos(rate * h) - std::cos(angle)) / below;
        const double by_sine = (std::sin(rate * h) - rate / omega * std::sin(angle)) / below;
        EXPECT_NEAR(flow.harmonic_q(0, 0)[i], load.cosine[i] * by_cosine + load.sine[i] * by_sine, 1e-15);
      }
    }
  });
}

TEST_F(Kernels, WhatForcesDoToStops) {
  on_every_target([] {
    constexpr Index kModes = 21, kStops = 19;
    const MatrixXd shapes = waves(kModes, kStops);
    const dynamics::StopShapes stops(shapes);
    dynamics::ContactPropagator flow(modes_over(kStep, kModes), modes_over(0.5 * kStep, kModes), stops,
                                     ArrayXd::LinSpaced(kModes, 0.0, kModes - 1.0), {});
    const Index padded = dynamics::ContactPropagator::padded(kStops),
                second = dynamics::ContactPropagator::next_register(0);
    const auto at_rest = [&] {
      return dynamics::StopMotion{ArrayXd::Zero(padded), ArrayXd::Zero(padded), ArrayXd::Zero(padded)};
    };
    const std::vector<Index> stop = {4, 17},
                             registers = {0, second, dynamics::ContactPropagator::next_register(second)};
    std::array<ArrayXd, 3> force;
    for (double phase = 0.0; ArrayXd & f : force) f = wave(kStops, ++phase).array();
    dynamics::StopMotion expected = at_rest(), together = at_rest(), apart = at_rest();
    double largest = 0.0;
    for (const Index i : stop) {
      Vector q = Vector::Zero(kModes), v = q, q_half = q;
      for (int k = 0; k < 3; ++k) {
        const double f = force[static_cast<std::size_t>(k)][i];
        q.array() += flow.whole.force_q(k) * shapes.col(i).array() * f;
        v.array() += kStep * flow.whole.force_v(k) * shapes.col(i).array() * f;
      }
      const double f0 = force[0][i], f1 = force[1][i], f2 = force[2][i];
      // Legendre polynomials P_1 and P_2 of the step, expressed in those of its first half
      q_half.array() +=
          shapes.col(i).array() * ((f0 - 0.5 * f1) * flow.half.force_q(0) +
                                   (0.5 * f1 - 0.75 * f2) * flow.half.force_q(1) + 0.25 * f2 * flow.half.force_q(2));
      const Vector end = shapes.transpose() * q, speed = shapes.transpose() * v, middle = shapes.transpose() * q_half;
      expected.end.head(kStops) += end.array();
      expected.speed.head(kStops) += speed.array();
      expected.middle.head(kStops) += middle.array();
      largest = (end.cwiseAbs() + 0.3 * speed.cwiseAbs() + middle.cwiseAbs()).maxCoeff();
      const double found = flow.add_force(i, {f0, f1, f2}, 0.3, registers, apart);
      EXPECT_NEAR(found, largest, kRounding * largest);
    }
    flow.add_forces(stop, force, registers, together);
    const double allowed = kRounding * largest;
    // Forces without a third moment, added at once and one by one.
    dynamics::StopMotion ramps = at_rest(), ramps_apart = at_rest();
    flow.add_forces(stop, {force[0], force[1], ArrayXd::Zero(kStops)}, registers, ramps);
    for (const Index i : stop) flow.add_force(i, {force[0][i], force[1][i], 0.0}, 0.3, registers, ramps_apart);
    EXPECT_LE((ramps.end - ramps_apart.end).abs().maxCoeff(), allowed);
    EXPECT_LE((ramps.speed - ramps_apart.speed).abs().maxCoeff(), allowed);
    EXPECT_LE((ramps.middle - ramps_apart.middle).abs().maxCoeff(), allowed);
    EXPECT_GT(ramps.end.abs().maxCoeff(), 0.0);
    for (const dynamics::StopMotion& motion : {together, apart}) {
      EXPECT_LE((motion.end - expected.end).abs().maxCoeff(), allowed);
      EXPECT_LE((motion.speed - expected.speed).abs().maxCoeff(), allowed);
      EXPECT_LE((motion.middle - expected.middle).abs().maxCoeff(), allowed);
    }
    // Only in the second register; then a force that is NaN.
    dynamics::StopMotion part = at_rest();
    flow.add_force(4, {1.0, 0.0, 0.0}, 0.3, std::vector<Index>{second}, part);
    EXPECT_EQ(part.end.head(second).abs().maxCoeff(), 0.0);
    EXPECT_GT(part.end.segment(second, second).abs().maxCoeff(), 0.0);
    EXPECT_FALSE(std::isfinite(flow.add_force(4, {std::nan(""), 0.0, 0.0}, 0.3, registers, part)));
  });
}

/// The message for a file that is not a module names the selected file.
std::string taken(const std::string& path) {
  try {
    (void)plugin::load_module(path);
  } catch (const RunError& error) {
    return error.what();
  }
  return "loaded";
}

TEST_F(Kernels, AModuleForTheChosenSetOrALowerOneComesFirst) {
  namespace fs = std::filesystem;
  const TemporaryFolder folder;
  fs::copy_file(std::string(BUTEE_TEST_PLUGINS) + "/smooth.so", folder.file("law.so"));
  EXPECT_EQ(taken(folder.file("law.so")), "loaded");
  const std::vector<std::string> all = targets();
  for (const std::string& own : {all.back(), all.front()}) {
    fs::create_directories(folder.file(own));
    folder.write(own + "/law.so", "no module");
    choose_target(all.front());
    EXPECT_EQ(taken(folder.file("law.so")).rfind(folder.file(own + "/law.so") + ": cannot be loaded", 0), 0U);
  }
  if (all.size() < 2) return;
  fs::remove(folder.file(all.back() + "/law.so"));
  choose_target(all.back());
  EXPECT_EQ(taken(folder.file("law.so")), "loaded") << "a higher set than the chosen one";
}

}  // namespace
}  // namespace butee::test::kernel_test
