#include <butee/record/impacts.hpp>
#include <gtest/gtest.h>

namespace butee::record {
namespace {

Impact impact(std::size_t contact, double t_in, std::optional<double> t_out, double force) {
  Impact made;
  made.contact = contact;
  made.node = "n";
  made.t_in = t_in;
  made.t_out = t_out;
  made.peak_force = force;
  made.impulse = 1.0;
  made.impact_speed = force;
  return made;
}

TEST(ImpactList, JoinsWhatRoundingHasParted) {
  ImpactList list;
  list.add(impact(0, 1.0, 1.0 + 2e-16, 5.0));
  list.add(impact(0, 1.0 + 4e-16, 1.01, 20.0));
  list.add(impact(0, 1.01 + 3e-15, 1.01 + 4e-15, 0.0));
  const std::vector<Impact> all = list.with({});
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].t_in, 1.0);
  EXPECT_EQ(*all[0].t_out, 1.01 + 4e-15);
  EXPECT_EQ(all[0].peak_force, 20.0);
  EXPECT_EQ(all[0].impulse, 3.0);
  EXPECT_EQ(all[0].impact_speed, 5.0);
}

TEST(ImpactList, KeepsShortFlightsAndOtherStopsApart) {
  ImpactList list;
  list.add(impact(0, 1.0, 1.01, 5.0));
  list.add(impact(1, 1.01, 1.02, 5.0));
  list.add(impact(0, 1.01 + 1e-11, 1.03, 5.0));
  list.add(impact(2, 0.9, 1.035, 5.0));
  EXPECT_EQ(list.with({}).size(), 4U);
}

TEST(ImpactList, JoinsWhatLasts) {
  ImpactList list;
  list.add(impact(0, 1.0, 1.01, 5.0));
  list.reach(1.02);
  const std::vector<Impact> all =
      list.with({impact(0, 1.01 + 1e-15, std::nullopt, 7.0), impact(1, 0.5, std::nullopt, 1.0)});
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].contact, 1U);
  EXPECT_EQ(all[1].contact, 0U);
  EXPECT_FALSE(all[1].t_out);
  EXPECT_EQ(all[1].peak_force, 7.0);
}

/// The first piece is as short as the gap after it; what follows lasts.
TEST(ImpactList, JoinsAPieceOfRoundingWithWhatLasts) {
  ImpactList list;
  list.add(impact(0, 1.0, 1.0 + 2e-16, 5.0));
  list.reach(1.01);
  const std::vector<Impact> all = list.with({impact(0, 1.0 + 4e-16, std::nullopt, 7.0)});
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].t_in, 1.0);
  EXPECT_FALSE(all[0].t_out);
}

}  // namespace
}  // namespace butee::record
