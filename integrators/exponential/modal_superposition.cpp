#include "integrators/exponential/modal_superposition.hpp"

#include <array>
#include <type_traits>
#include <utility>

namespace butee::integrators {
namespace {

using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Numbers whose sums stay in registers.
constexpr int kInRegisters = 32;
/// Products go through the natural modes if that takes at most this part of the multiplications.
constexpr double kWorthwhile = 0.7;

/// Calls `some(first, size)` for groups of kTogether numbers up to `count` and for the rest one by one.
template <int kTogether, class Some>
void in_groups(Index count, const Some& some) {
  Index i = 0;
  for (; i + kTogether <= count; i += kTogether) some(i, std::integral_constant<int, kTogether>());
  for (; i < count; ++i) some(i, std::integral_constant<int, 1>());
}

/// Row place(i) of `out` := row i of a * b
template <int kCount, class Place>
void multiply(const Rows& a, const LanesOf<kCount>& b, const Place& place, LanesOf<kCount>& out) {
  in_groups<kInRegisters / kCount>(a.rows(), [&](Index first, auto size) {
    constexpr int kSize = decltype(size)::value;
    const double* const rows = a.data() + first * a.cols();
    std::array<LaneOf<kCount>, kSize> sums;
    for (auto& sum : sums) sum.setZero();
    for (Index j = 0; j < a.cols(); ++j) {
      const LaneOf<kCount> other = lane_of<kCount>(b, j);
      for (int r = 0; r < kSize; ++r) sums[static_cast<std::size_t>(r)] += rows[r * a.cols() + j] * other;
    }
    for (int r = 0; r < kSize; ++r) lane_of<kCount>(out, place(first + r)) = sums[static_cast<std::size_t>(r)];
  });
}

/// Row to(j) of `out` := row j of a^T b, where row i of b is row from(i) of `f`
template <class From, class To>
void multiply_transposed(const Rows& a, const Lanes& f, const From& from, const To& to, Lanes& out) {
  in_groups<kInRegisters / Lanes::ColsAtCompileTime>(a.cols(), [&](Index first, auto size) {
    constexpr int kSize = decltype(size)::value;
    std::array<Lane, kSize> sums;
    for (Lane& sum : sums) sum.setZero();
    for (Index i = 0; i < a.rows(); ++i) {
      const double* const row = a.data() + i * a.cols() + first;
      const Lane other = lane_of<8>(f, from(i));
      for (int r = 0; r < kSize; ++r) sums[static_cast<std::size_t>(r)] += row[r] * other;
    }
    for (int r = 0; r < kSize; ++r) lane_of<8>(out, to(first + r)) = sums[static_cast<std::size_t>(r)];
  });
}

constexpr auto kSame = [](Index i) { return i; };

}  // namespace

void ModalSuperposition::choose(const std::vector<Index>& dofs) {
  count_ = static_cast<Index>(dofs.size());
  const dynamics::DampedModes::Natural& natural = modes_.natural();
  const Index n = natural.shapes.rows(), rows = 2 * modes_.count();
  parts_.clear();
  std::vector<Index> place(static_cast<std::size_t>(n), -1);
  for (Index k = 0; k < count_; ++k) place[static_cast<std::size_t>(dofs[static_cast<std::size_t>(k)])] = k;
  Index work = natural.displacement.nonZeros();
  for (const auto& [part_dofs, part_modes] : natural.parts) {
    Part part{part_modes, {}, {}};
    std::vector<Index> chosen;
    for (const Index dof : part_dofs)
      if (const Index k = place[static_cast<std::size_t>(dof)]; k >= 0) {
        part.rows.push_back(k);
        chosen.push_back(dof);
      }
    if (chosen.empty()) continue;
    part.shapes = natural.shapes(chosen, part_modes);
    work += part.shapes.size();
    parts_.push_back(std::move(part));
  }
  if (static_cast<double>(work) < kWorthwhile * static_cast<double>(rows * count_)) {
    in_ = natural.input;
    natural_.setZero(n, Lanes::ColsAtCompileTime);
    moved_.resize(n, Lanes::ColsAtCompileTime);
    return;
  }
  parts_.clear();
  displacement_.resize(count_, rows);
  velocity_.resize(count_, rows);
  input_.resize(rows, count_);
  for (Index k = 0; k < count_; ++k) {
    const Index dof = dofs[static_cast<std::size_t>(k)];
    displacement_.row(k) = modes_.displacement().col(dof).transpose();
    velocity_.row(k) = modes_.velocity().col(dof).transpose();
    input_.col(k) = modes_.input().col(dof);
  }
}

void ModalSuperposition::superpose(const Combination& natural, const Rows& direct, const Lanes& z, Lanes& out) {
  out.resize(count_, Lanes::ColsAtCompileTime);
  if (parts_.empty()) return multiply<8>(direct, z, kSame, out);
  for (const Part& part : parts_) {
    for (std::size_t i = 0; i < part.modes.size(); ++i) {
      Lane sum = Lane::Zero();
      for (Combination::InnerIterator entry(natural, part.modes[i]); entry; ++entry)
        sum += entry.value() * lane_of<8>(z, entry.row());
      lane_of<8>(moved_, static_cast<Index>(i)) = sum;
    }
    multiply<8>(
        part.shapes, moved_, [&part](Index i) { return part.rows[static_cast<std::size_t>(i)]; }, out);
  }
}

void ModalSuperposition::displacements(const Lanes& z, Lanes& x) {
  superpose(modes_.natural().displacement, displacement_, z, x);
}

void ModalSuperposition::velocities(const Lanes& z, Lanes& v) {
  superpose(modes_.natural().velocity, velocity_, z, v);
}

void ModalSuperposition::motions(const Eigen::VectorXd& one, const Eigen::VectorXd& other, LanesOf<4>& out) {
  out.resize(count_, 4);
  if (parts_.empty()) {
    for (Index k = 0; k < 2; ++k) {
      const Eigen::VectorXd& z = k == 0 ? one : other;
      out.col(k).noalias() = displacement_ * z;
      out.col(2 + k).noalias() = velocity_ * z;
    }
    return;
  }
  const dynamics::DampedModes::Natural& natural = modes_.natural();
  for (const Part& part : parts_) {
    pairs_.resize(static_cast<Index>(part.modes.size()), 4);
    for (std::size_t i = 0; i < part.modes.size(); ++i) {
      const auto sums = [&](const Combination& combination) {
        double of_one = 0.0, of_other = 0.0;
        for (Combination::InnerIterator entry(combination, part.modes[i]); entry; ++entry) {
          of_one += entry.value() * one[entry.row()];
          of_other += entry.value() * other[entry.row()];
        }
        return std::pair(of_one, of_other);
      };
      const auto [x, other_x] = sums(natural.displacement);
      const auto [v, other_v] = sums(natural.velocity);
      lane_of<4>(pairs_, static_cast<Index>(i)) << x, other_x, v, other_v;
    }
    multiply<4>(
        part.shapes, pairs_, [&part](Index i) { return part.rows[static_cast<std::size_t>(i)]; }, out);
  }
}

void ModalSuperposition::modal_forces(const Lanes& f, Lanes& rates) {
  rates.resize(2 * modes_.count(), Lanes::ColsAtCompileTime);
  if (parts_.empty()) return multiply<8>(input_, f, kSame, rates);
  for (const Part& part : parts_)
    multiply_transposed(
        part.shapes, f, [&part](Index i) { return part.rows[static_cast<std::size_t>(i)]; },
        [&part](Index j) { return part.modes[static_cast<std::size_t>(j)]; }, natural_);
  for (Index k = 0; k < rates.rows(); ++k) {
    Lane sum = Lane::Zero();
    for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator entry(in_, k); entry; ++entry)
      sum += entry.value() * lane_of<8>(natural_, entry.col());
    lane_of<8>(rates, k) = sum;
  }
}

}  // namespace butee::integrators
