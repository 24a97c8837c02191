#include <butee/embed/structure.hpp>
#include <gtest/gtest.h>

#include "support/scene_run.hpp"

namespace butee::test::stopped_test {
namespace {

TEST(AdvanceTo, GoesOnToTheBitFromWhereItWasStopped) {
  const std::string scene = std::string(BUTEE_TEST_MODELS) + "/beam1.toml";
  auto whole = embed::Structure::from_file(scene), stopped = embed::Structure::from_file(scene);
  whole.advance_to(0.01);
  int steps = 0, stops = 0;
  while (!stopped.advance_to(0.01, [&] { return ++steps % 100 != 0; })) ++stops;
  EXPECT_GT(stops, 2);
  EXPECT_EQ(stopped.time(), 0.01);
  EXPECT_EQ(stopped.report().steps, whole.report().steps);
  EXPECT_EQ(stopped.state().x, whole.state().x);
  EXPECT_EQ(stopped.state().v, whole.state().v);
}

}  // namespace
}  // namespace butee::test::stopped_test
