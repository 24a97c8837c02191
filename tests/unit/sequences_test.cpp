#include <algorithm>
#include <cmath>
#include <vector>

#include <butee/study/plan.hpp>
#include <gtest/gtest.h>

namespace butee::test::sequences_test {
namespace {

using study::LatinHypercube;
using study::Sobol;

/// Output of Joe and Kuo's own program for ten dimensions (https://web.maths.unsw.edu.au/~fkuo/sobol/).
const std::vector<std::vector<double>> kPublished = {
    {0, 0, 0, 0, 0, 0, 0, 0, 0, 0},
    {0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5},
    {0.75, 0.25, 0.25, 0.25, 0.75, 0.75, 0.25, 0.75, 0.75, 0.75},
    {0.25, 0.75, 0.75, 0.75, 0.25, 0.25, 0.75, 0.25, 0.25, 0.25},
    {0.375, 0.375, 0.625, 0.875, 0.375, 0.125, 0.375, 0.875, 0.875, 0.625},
    {0.875, 0.875, 0.125, 0.375, 0.875, 0.625, 0.875, 0.375, 0.375, 0.125},
    {0.625, 0.125, 0.875, 0.625, 0.625, 0.875, 0.125, 0.125, 0.125, 0.375},
    {0.125, 0.625, 0.375, 0.125, 0.125, 0.375, 0.625, 0.625, 0.625, 0.875}};

TEST(Sobol, MeetsThePublishedPoints) {
  const Sobol sobol(10);
  for (std::size_t i = 0; i < kPublished.size(); ++i)
    for (std::size_t d = 0; d < 10; ++d) EXPECT_EQ(sobol.at(i, d), kPublished[i][d]) << i << " " << d;
}

/// Points 1023 and 100000 of scipy.stats.qmc.Sobol(21, scramble=False), times 2^17.
TEST(Sobol, MeetsScipyInAllDimensions) {
  const Sobol sobol(Sobol::kMostDimensions);
  const std::vector<std::pair<std::uint64_t, std::vector<double>>> expected = {
      {1023, {128,  98688, 80256, 19072, 24448, 57472, 18304,  81024, 45184, 111488, 88960,
              4736, 17024, 87168, 47488, 60800, 41088, 114816, 76672, 41856, 113536}},
      {100000, {8005,  14101, 123677, 81371, 79371, 126573, 7997,  4685,  2673,  100921, 36431,
                59227, 74081, 25803,  12609, 7771,  127815, 32269, 56835, 14275, 32067}}};
  for (const auto& [index, point] : expected)
    for (std::size_t d = 0; d < point.size(); ++d)
      EXPECT_EQ(sobol.at(index, d) * 0x1p17, point[d]) << index << " " << d;
}

TEST(Sobol, HasOnePointInEveryIntervalOfEveryDimension) {
  constexpr std::size_t kCount = 1024;
  for (const std::optional<std::uint64_t> seed : {std::optional<std::uint64_t>(), std::optional<std::uint64_t>(7)}) {
    const Sobol sobol(Sobol::kMostDimensions, seed);
    for (std::size_t d = 0; d < Sobol::kMostDimensions; ++d) {
      std::vector<int> hits(kCount);
      for (std::size_t i = 0; i < kCount; ++i) ++hits[static_cast<std::size_t>(sobol.at(i, d) * kCount)];
      EXPECT_EQ(std::count(hits.begin(), hits.end(), 1), static_cast<std::ptrdiff_t>(kCount)) << d;
    }
  }
}

/// The first two dimensions are a (0, m, 2) net, which a digital shift keeps.
TEST(Sobol, HasOnePointInEveryElementaryRectangle) {
  constexpr unsigned kPower = 8;
  for (const std::optional<std::uint64_t> seed : {std::optional<std::uint64_t>(), std::optional<std::uint64_t>(3)}) {
    const Sobol sobol(2, seed);
    for (unsigned a = 0; a <= kPower; ++a) {
      const unsigned columns = 1U << a, rows = 1U << (kPower - a);
      std::vector<int> hits(std::size_t{columns} * rows);
      for (std::uint64_t i = 0; i < hits.size(); ++i)
        ++hits[static_cast<std::size_t>(sobol.at(i, 0) * columns) * rows +
               static_cast<std::size_t>(sobol.at(i, 1) * rows)];
      EXPECT_EQ(std::count(hits.begin(), hits.end(), 1), std::ssize(hits)) << a;
    }
  }
}

TEST(Sobol, SeedsGiveOtherPoints) {
  const Sobol plain(3), shifted(3, 1), other(3, 2);
  int different = 0;
  for (std::uint64_t i = 0; i < 64; ++i)
    different += plain.at(i, 2) != shifted.at(i, 2) && shifted.at(i, 2) != other.at(i, 2) ? 1 : 0;
  EXPECT_EQ(different, 64);
}

TEST(LatinHypercube, HasOnePointInEveryInterval) {
  constexpr std::uint32_t kCount = 1000;
  const LatinHypercube plan(kCount, 5, 42), again(kCount, 5, 42), other(kCount, 5, 43);
  std::vector<double> means;
  for (std::size_t d = 0; d < 5; ++d) {
    std::vector<int> hits(kCount);
    double correlation = 0.0;
    for (std::uint64_t i = 0; i < kCount; ++i) {
      ++hits[static_cast<std::size_t>(plan.at(i, d) * kCount)];
      EXPECT_EQ(plan.at(i, d), again.at(i, d));
      correlation += (plan.at(i, d) - 0.5) * (plan.at(i, (d + 1) % 5) - 0.5) * 12.0 / kCount;
    }
    EXPECT_EQ(std::count(hits.begin(), hits.end(), 1), static_cast<std::ptrdiff_t>(kCount)) << d;
    EXPECT_LT(std::abs(correlation), 0.15) << d;  // five standard deviations for 1000 points
  }
  EXPECT_NE(plan.at(0, 0), other.at(0, 0));
}

std::vector<double> numbers_of(const std::vector<config::Value>& values) {
  std::vector<double> numbers;
  for (const config::Value& value : values) numbers.push_back(std::get<double>(value.data));
  return numbers;
}

study::Axis axis_of(const std::string& key, std::vector<double> values) {
  study::Axis axis{key, {}};
  for (const double value : values) axis.values.emplace_back(value);
  return axis;
}

TEST(Plan, GridHasTheLastAxisTheFastest) {
  const study::Plan plan({axis_of("a", {1, 2}), axis_of("b", {10, 20, 30})}, study::PlanKind::grid, 0, {},
                         study::Follow::no);
  ASSERT_EQ(plan.run_count(), 6);
  EXPECT_EQ(plan.chain_count(), 6);
  EXPECT_EQ(numbers_of(plan.values(1)), (std::vector<double>{1, 20}));
  EXPECT_EQ(numbers_of(plan.values(3)), (std::vector<double>{2, 10}));
}

TEST(Plan, SweepsGoUpAndDownTheLastAxis) {
  const study::Plan plan({axis_of("a", {1, 2}), axis_of("b", {10, 20, 30})}, study::PlanKind::grid, 0, {},
                         study::Follow::both);
  ASSERT_EQ(plan.run_count(), 12);
  ASSERT_EQ(plan.chain_count(), 4);
  std::vector<double> up, down;
  for (std::int64_t i = 0; i < 3; ++i) {
    up.push_back(numbers_of(plan.values(plan.run(plan.chain(1).at(i)).point))[1]);
    down.push_back(numbers_of(plan.values(plan.run(plan.chain(3).at(i)).point))[1]);
    EXPECT_EQ(plan.run(plan.chain(1).at(i)).direction, 1);
    EXPECT_EQ(plan.run(plan.chain(3).at(i)).direction, -1);
    EXPECT_EQ(numbers_of(plan.values(plan.run(plan.chain(3).at(i)).point))[0], 2.0);
  }
  EXPECT_EQ(up, (std::vector<double>{10, 20, 30}));
  EXPECT_EQ(down, (std::vector<double>{30, 20, 10}));
}

TEST(Plan, RangesMeetTheirEndsToTheBit) {
  study::Axis linear{"a", {}, study::Axis::Range{0.1, 0.7, false}, 7},
      logarithmic{"b", {}, study::Axis::Range{1e-3, 1e2, true}, 6};
  EXPECT_EQ(std::get<double>(linear.value(6).data), 0.7);
  EXPECT_EQ(std::get<double>(logarithmic.value(5).data), 1e2);
  EXPECT_EQ(std::get<double>(logarithmic.value(2).data), 0.1);
  EXPECT_EQ(std::get<double>(linear.value(2).data), 0.3);
}

}  // namespace
}  // namespace butee::test::sequences_test
