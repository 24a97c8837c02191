// Equal motions in one plane, in two planes and in space.
#include <cmath>

#include <butee/model/element_choice.hpp>
#include <gtest/gtest.h>

#include "support/cantilever.hpp"
#include "support/scene_run.hpp"

namespace butee::test::planes_test {
namespace {

/// The same motion along z of a lateral beam and along y of a planar beam.
TEST(Planes, AreAlike) {
  const auto run = [](const std::string& motion, const std::string& dof, DofKind kind) {
    const std::string fixed = dof == "u" ? "theta" : "ry", rest = motion == "planar" ? "" : ", \"u\", \"theta\"";
    SceneRun scene(steel_bar() +
                       std::string("[[element]]\ntype = \"beam\"\nname = \"arm\"\nlength = 1.0\nelements = 8\n") +
                       "material = \"steel\"\nsection = \"square\"\nmotion = \"" + motion +
                       "\"\n[section.square]\nshape = \"rectangle\"\nwidth = 0.04\nheight = 0.04\n[[support]]\nnodes = "
                       "\"arm:first\"\nfix = [\"" +
                       dof + "\", \"" + fixed + "\"" + rest +
                       "]\n[[load]]\ntype = \"constant\"\nnode = \"arm:last\"\ndof = \"" + dof + "\"\nvalue = 100.0\n",
                   {"integrator.type=rodas4", "integrator.end_time=0.05", "integrator.tolerance=1e-6"});
    Sampler tip(scene.dof("arm:last", kind), {0.01, 0.02, 0.05});
    scene.simulation().add(tip);
    EXPECT_TRUE(scene.run().completed);
    return tip.x;
  };
  const auto y = run("planar", "u", DofKind::uy), z = run("lateral", "uz", DofKind::uz);
  // Steps differ only by rounding.
  EXPECT_LT(relative_rms(z, y), 1e-9);
}

/// Round beams have equal frequencies in both planes; the modes of the planes must not mix. Otherwise
/// rounding would appear as motion in the unloaded plane, which has a stop, and no step would be short enough
/// for it.
TEST(Planes, ALoadInOneLeavesTheOtherAtRest) {
  const std::string scene =
      steel_bar() + std::string(
                        "[section.round]\nshape = \"circle\"\nradius = 0.047\n[[element]]\ntype = \"beam\"\n"
                        "name = \"b\"\nmotion = \"lateral\"\nmaterial = \"steel\"\nsection = \"round\"\n"
                        "length = 2.2\nelements = 4\n[[support]]\nnodes = [\"b:first\", \"b:last\"]\n"
                        "fix = [\"uy\", \"uz\"]\n[[contact]]\ntype = \"stop\"\nnodes = \"b:1\"\ngap = 2e-4\n"
                        "stiffness = 4e7\n[damping]\nstiffness_proportional = 6e-5\n[[load]]\ntype = "
                        "\"harmonic\"\nnode = \"b:1\"\ndof = \"uz\"\namplitude = 600.0\n"
                        "angular_frequency = 140.0\nphase = 0.7\n");
  const auto run = [&](const char* method) {
    SceneRun one(scene, {std::string("integrator.type=") + method, "integrator.end_time=0.05"});
    EXPECT_TRUE(one.run().completed) << one.simulation().report().message;
    EXPECT_EQ(one.simulation().state().x[one.dof("b:1", DofKind::uy)], 0.0) << method;
    return one.simulation().state().x[one.dof("b:1", DofKind::uz)];
  };
  const double wanted = run("exact");
  EXPECT_NEAR(run("exponential"), wanted, 1e-3 * std::abs(wanted));
}

TEST(Planes, ForcesThatWouldBeIncompleteAreRefused) {
  const auto why = [](const std::string& toml, model::Quantity quantity, const std::string& node) {
    SceneRun run(toml);
    const model::NodeId id = run.model().nodes.select(node).nodes.front();
    return model::why_not(quantity, run.model(), run.system().dofs, id, "");
  };
  const std::string arm = cantilever("[[0, 0, 0], [1, 0, 0]]", "");
  EXPECT_NE(why(arm, model::Quantity::von_mises, "arm:first").find("only for round sections"), std::string::npos);
  EXPECT_EQ(why(arm, model::Quantity::bending_moment, "arm:first"), "");
  EXPECT_EQ(why(arm, model::Quantity::torque, "arm:first"), "");
  EXPECT_EQ(why(arm, model::Quantity::reaction_rx, "arm:first"), "");
  EXPECT_NE(why(arm, model::Quantity::reaction_rx, "arm:last").find("is free"), std::string::npos);
  std::string planar = arm.substr(0, arm.find("[[support]]"));
  planar.replace(planar.find("spatial"), 7, "planar");
  EXPECT_NE(why(planar, model::Quantity::torque, "arm:first").find("motion = \"spatial\""), std::string::npos);
  EXPECT_NE(why(planar, model::Quantity::shear_z, "arm:first").find("motion = \"lateral\""), std::string::npos);
}

}  // namespace
}  // namespace butee::test::planes_test
