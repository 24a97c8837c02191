// The method that `auto` chooses for a scene.
#include <butee/core/text.hpp>
#include <gtest/gtest.h>

#include "support/program.hpp"
#include "support/scene_run.hpp"

namespace butee::test::automatic_test {
namespace {

std::string beam(int elements, const std::string& more, const std::string& integrator = "end_time = 0.05\n") {
  return "schema = 1\n[material.s]\nyoung_modulus = 2e11\ndensity = 7900\n[section.c]\nshape = \"circle\"\nradius = "
         "0.02\n[[element]]\ntype = \"beam\"\nname = \"b\"\nmaterial = \"s\"\nsection = \"c\"\nlength = 4.0\nelements "
         "= " +
         std::to_string(elements) +
         "\n[[support]]\nnodes = [\"b:first\", \"b:last\"]\nfix = [\"u\"]\n[[load]]\ntype = \"harmonic\"\nnode = "
         "\"b:1\"\namplitude = 500.0\nangular_frequency = 60.0\n" +
         more + "[integrator]\n" + integrator;
}

const std::string kStops = "[[contact]]\ntype = \"stop\"\nnodes = \"b:all\"\ngap = 1e-3\nstiffness = 1e6\n";
const std::string kDashpot = "[[element]]\ntype = \"spring\"\nnode = \"b:2\"\nstiffness = 1e4\ndamping = 50.0\n";

TEST(Automatic, TakesWhatSuitsTheScene) {
  const auto choice = [](const std::string& scene) { return SceneRun(scene).integrator().choice(); };
  EXPECT_EQ(choice(beam(6, "")).rfind("exponential with tolerance 0.0001: there are no stops", 0), 0U);
  EXPECT_EQ(choice(beam(6, kStops)).rfind("exponential with tolerance 0.0001: all modes of 12 DOFs", 0), 0U);
  EXPECT_EQ(choice(beam(6, kStops + kDashpot)).rfind("exponential with tolerance 0.0001: the linear part", 0), 0U);
  // Far from its gap a stop pulls with k/(pi^2 lambda), 1e-6, 1e-3 or 1e-2 of the force that closes the gap. With two
  // sides this jumps in the middle.
  const auto pulling = [&](const std::string& sides, const std::string& regularization, const std::string& tolerance) {
    return choice(
        beam(6, kStops + "law = \"arctan\"\nregularization = " + regularization + "\nsides = \"" + sides + "\"\n",
             "end_time = 0.05\ntolerance = " + tolerance + "\n"));
  };
  EXPECT_EQ(pulling("positive", "1e8", "1e-5").rfind("exponential", 0), 0U);
  EXPECT_EQ(pulling("both", "1e8", "1e-4").rfind("exponential", 0), 0U);
  EXPECT_EQ(pulling("positive", "1e5", "1e-6").rfind("exponential", 0), 0U);
  EXPECT_EQ(pulling("both", "1e5", "1e-6").rfind("exponential", 0), 0U);
  EXPECT_EQ(pulling("both", "1e5", "1e-9").rfind("exact", 0), 0U);
  EXPECT_EQ(pulling("both", "1e4", "1e-6").rfind("exponential", 0), 0U);
  // Computing the modes of 400 DOFs takes longer than integrating a few waves, but less than half a second of
  // impacts.
  EXPECT_EQ(choice(beam(200, kStops, "end_time = 1e-4\ntolerance = 1e-3\n"))
                .rfind("rodas4 with tolerance 0.001: the modes of 400", 0),
            0U);
  EXPECT_EQ(choice(beam(200, kStops, "end_time = 0.5\n"))
                .rfind("exponential with tolerance 0.0001: all modes of 400 DOFs", 0),
            0U);
  // A load that begins sets fast modes in motion, in which rodas4 took 289 000 steps.
  EXPECT_EQ(choice(beam(100,
                        "[[contact]]\ntype = \"stop\"\nnodes = \"b:25\"\ngap = 0.01\nstiffness = 2e3\n[[load]]\ntype = "
                        "\"harmonic\"\nnode = \"b:50\"\namplitude = 3e3\nangular_frequency = 12.0\n",
                        "end_time = 0.1\ntolerance = 1e-3\n"))
                .rfind("exponential with tolerance 0.001: all modes of 200 DOFs", 0),
            0U);
  EXPECT_EQ(choice(beam(400, kStops)).rfind("rodas4 with tolerance 0.0001 on the moving part: 800 DOFs", 0), 0U);
  const std::string weight =
      "[[load]]\ntype = \"distributed\"\nbeam = \"b\"\nvalue = 10.0\nin_time = {type = \"constant\", value = 1.0}\n";
  EXPECT_EQ(choice(beam(400, kStops + weight)).rfind("rodas4 with tolerance 0.0001: 800 DOFs", 0), 0U);
  EXPECT_EQ(choice(beam(6, "", "end_time = 0.05\ntolerance = 1e-3\n")).rfind("exponential with tolerance 0.001", 0),
            0U);
}

/// Where damping leaves the steps of rodas4 to slow motion they are long at any tolerance, unless a force jumps.
TEST(Automatic, KeepsImplicitStepsWhereFastMotionIsDamped) {
  const auto choice = [](const std::string& law) {
    return SceneRun(beam(6, kStops + law + "[damping]\nstiffness_proportional = 1e-3\n",
                         "end_time = 0.05\ntolerance = 1e-9\n"))
        .integrator()
        .choice();
  };
  EXPECT_EQ(choice("").rfind("rodas4", 0), 0U) << choice("");
  const std::string arctan = "law = \"arctan\"\nregularization = 1e5\n";
  EXPECT_EQ(choice(arctan).rfind("exact", 0), 0U) << choice(arctan);
}

/// Damped modes of 200 DOFs take longer to compute than a few waves, and those of one block of 200 modes longer than
/// those of many small blocks.
TEST(Automatic, TakesDampedModesWhereTheRunIsWorthThem) {
  const auto choice = [](const std::string& end_time) {
    return SceneRun(beam(100, kStops + kDashpot, "tolerance = 1e-3\nend_time = " + end_time + "\n"))
        .integrator()
        .choice();
  };
  EXPECT_NE(choice("1e-4").find("rodas4 with tolerance 0.001: dashpots couple"), std::string::npos) << choice("1e-4");
  EXPECT_NE(choice("2e-3").find("200 modes are coupled"), std::string::npos) << choice("2e-3");
  EXPECT_EQ(choice("0.5").rfind("exponential with tolerance 0.001: the linear part", 0), 0U) << choice("0.5");
}

/// One mass between stops, as problem SDND121 of Code_Aster's suite.
std::string oscillator(const std::string& tolerance, double stop = 1e10, const std::string& damping = "0.0",
                       const std::string& more = "") {
  return "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 156.0\n[[element]]\ntype = "
         "\"spring\"\nnode = \"m\"\nstiffness = 2e6\ndamping = " +
         damping +
         "\n[[contact]]\ntype = \"stop\"\nnodes = \"m\"\ngap = 1e-3\nlaw = \"linear\"\nstiffness = " + to_text(stop) +
         "\n[[load]]\ntype = \"harmonic\"\nnode = \"m\"\namplitude = 3000.0\nangular_frequency = "
         "31.4159265358979\nphase = -1.5707963267948966\n" +
         more + "[integrator]\nend_time = 0.4\ntolerance = " + tolerance + "\n";
}

TEST(Automatic, TakesPiecewiseForFewDofsWithLinearStops) {
  const auto choice = [](const std::string& scene) { return SceneRun(scene).integrator().choice(); };
  for (const std::string& scene :
       {oscillator("1e-6"), oscillator("1e-2", 1e7), oscillator("1e-6", 1e10, "1e4"),
        oscillator("1e-4", 1e10, "0.0",
                   "[[element]]\ntype = \"mass\"\nname = \"n\"\nmass = 1.0\n[[element]]\n"
                   "type = \"spring\"\nnodes = [\"m\", \"n\"]\nstiffness = 1e4\ndamping = 3.0\n")})
    EXPECT_EQ(choice(scene).rfind("piecewise: ", 0), 0U) << choice(scene);
  EXPECT_EQ(choice(beam(6, kStops)).rfind("exponential", 0), 0U);
  SceneRun chosen(oscillator("1e-6")), named(oscillator("1e-6") + "type = \"piecewise\"\n");
  ASSERT_TRUE(chosen.run().completed);
  ASSERT_TRUE(named.run().completed);
  EXPECT_TRUE(chosen.simulation().state().x == named.simulation().state().x);
}

/// Below the tolerances of exponential, and where it refuses a scene.
TEST(Automatic, TakesMethodsOfHighOrderForTightTolerances) {
  const auto choice = [](const std::string& more, const std::string& integrator) {
    return SceneRun(beam(6, more, integrator)).integrator().choice();
  };
  const std::string tight = "tolerance = 1e-9\nend_time = ";
  EXPECT_EQ(choice(kStops, tight + "0.05\n").rfind("exact: the tolerance is below", 0), 0U);
  EXPECT_EQ(choice(kStops, tight + "1e4\n").rfind("rodas4 with tolerance 1e-09: the tolerance is below", 0), 0U);
  EXPECT_EQ(choice(kStops, "tolerance = 1e-8\nend_time = 0.05\n").rfind("exponential", 0), 0U);
  const std::string curved = kStops + "law = \"hertz\"\n";
  EXPECT_EQ(choice(curved, tight + "0.05\n").rfind("extrapolation8 with tolerance 1e-09", 0), 0U);
}

/// A shaft that runs up in a ring. Strong damping of its fast modes leaves rodas4 long steps.
TEST(Automatic, TakesExponentialForRunUpsUnlessFastModesAreDamped) {
  const auto choice = [](const std::string& damping) {
    return SceneRun(
               "schema = 1\n[material.s]\nyoung_modulus = 2e11\ndensity = 7900\n[section.c]\nshape = "
               "\"circle\"\nradius = "
               "0.02\n[[element]]\ntype = \"beam\"\nname = \"b\"\nmaterial = \"s\"\nsection = \"c\"\nmotion = "
               "\"lateral\"\ntheory = \"rayleigh\"\n"
               "length = 2.0\nelements = 4\n[[support]]\nnodes = [\"b:first\", \"b:last\"]\nfix = [\"uy\", \"uz\"]\n"
               "[rotation]\nspeed = {type = \"ramp\", from = 0.0, to = 100.0, end = 1.0}\n[[load]]\ntype = "
               "\"unbalance\"\nnode = \"b:2\"\nmoment = 1e-3\n[[contact]]\ntype = \"ring\"\nnodes = \"b:2\"\ngap = "
               "1e-3\nstiffness = 1e6\n[damping]\nstiffness_proportional = " +
               damping + "\n[integrator]\nend_time = 1.0\n")
        .integrator()
        .choice();
  };
  EXPECT_EQ(choice("1e-7").rfind("exponential", 0), 0U) << choice("1e-7");
  EXPECT_EQ(choice("1e-3").rfind("rodas4", 0), 0U) << choice("1e-3");
}

/// Implicit methods for bodies that creep under regularised friction and for damped structures, explicit ones for other
/// contacts that exponential does not treat; exponential itself with slopes that are infinite where contacts close.
TEST(Automatic, TakesExplicitMethodsWhereFastModesMove) {
  const auto choice = [](const std::string& contact, const std::string& more = "", int elements = 6) {
    return SceneRun(
               beam(elements, "[[contact]]\nnodes = \"b:1\"\n" + contact + more, "end_time = 0.05\ntolerance = 1e-3\n"))
        .integrator()
        .choice();
  };
  const auto begins = [](const std::string& chosen, const char* method) { return chosen.rfind(method, 0) == 0; };
  const auto support = [](const char* speed) {
    return "type = \"friction\"\ndof = \"u\"\nnormal_force = 100.0\nfriction = { coefficient = 0.3, slip_speed = " +
           std::string(speed) + " }\n";
  };
  const std::string jankowski =
                        "type = \"stop\"\ngap = 1e-3\nlaw = \"hertz\"\nstiffness = 1e8\ndamping = { type = "
                        "\"jankowski\", restitution = 0.6, mass = 1.0 }\n",
                    pulling =
                        "type = \"stop\"\ngap = 1e-3\nlaw = \"arctan\"\nregularization = 1e5\nstiffness = "
                        "1e6\ndamping = { type = \"hunt_crossley\", factor = 0.5 }\n",
                    damped = "[damping]\nstiffness_proportional = 1e-2\n";
  EXPECT_TRUE(begins(choice(support("1e-6")), "rodas4")) << choice(support("1e-6"));
  EXPECT_TRUE(begins(choice(support("1e-1")), "exponential")) << choice(support("1e-1"));
  EXPECT_TRUE(begins(choice(jankowski), "exponential")) << choice(jankowski);
  EXPECT_TRUE(begins(choice(jankowski, "", 2), "dopri5")) << choice(jankowski, "", 2);
  SceneRun rotor(
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 1.0\n[[element]]\ntype = \"spring\"\nnode = "
      "\"m\"\ndof = \"uy\"\nstiffness = 1e4\n[[element]]\ntype = \"spring\"\nnode = \"m\"\ndof = \"uz\"\nstiffness = "
      "1e4\n[[contact]]\nnodes = \"m\"\ntype = \"ring\"" +
      jankowski.substr(jankowski.find('\n')) + "[integrator]\nend_time = 0.05\n");
  EXPECT_TRUE(begins(rotor.integrator().choice(), "exponential")) << rotor.integrator().choice();
  SceneRun on_plane(
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 1.0\n[[element]]\ntype = \"spring\"\nnode = "
      "\"m\"\ndof = \"uy\"\nstiffness = 1e4\n[[element]]\ntype = \"spring\"\nnode = \"m\"\ndof = \"uz\"\nstiffness = "
      "1e4\n[[contact]]\nnodes = \"m\"\ntype = \"plane\"\nnormal = [1.0, 0.0]" +
      jankowski.substr(jankowski.find('\n')) + "[integrator]\nend_time = 0.05\n");
  EXPECT_TRUE(begins(on_plane.integrator().choice(), "dopri5")) << on_plane.integrator().choice();
  // The rate of the friction is 0.1/(2e-5 * 100) = 50 times the frequency; rodas4 takes short steps at a tight
  // tolerance.
  for (const auto& [tolerance, method] : {std::pair{"1e-3", "rodas4"}, std::pair{"1e-5", "exponential"}}) {
    SceneRun held(
        "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 1.0\n[[element]]\ntype = \"spring\"\nnode = "
        "\"m\"\nstiffness = 1e4\n[[contact]]\nnodes = \"m\"\ntype = \"friction\"\ndof = \"u\"\nnormal_force = "
        "1.0\nfriction = { coefficient = 0.1, slip_speed = 2e-5 }\n[integrator]\nend_time = 0.05\ntolerance = " +
        std::string(tolerance) + "\n[initial]\nvelocity = [{ nodes = \"m\", value = 0.1 }]\n");
    EXPECT_TRUE(begins(held.integrator().choice(), method)) << tolerance << held.integrator().choice();
  }
  EXPECT_TRUE(begins(choice(pulling), "extrapolation8")) << choice(pulling);
  EXPECT_TRUE(begins(choice(pulling, damped), "rodas4")) << choice(pulling, damped);
}

TEST(Automatic, IsTheMethodThatItTook) {
  for (const std::string& more : {kStops, kStops + kDashpot}) {
    SceneRun chosen(beam(6, more)), named(beam(6, more, "end_time = 0.05\ntype = \"exponential\"\n"));
    ASSERT_TRUE(chosen.run().completed);
    ASSERT_TRUE(named.run().completed);
    EXPECT_TRUE(chosen.simulation().state().x == named.simulation().state().x);
    EXPECT_TRUE(named.integrator().choice().empty());
  }
}

TEST(Automatic, SaysWhatItTook) {
  const TemporaryFolder folder;
  folder.write("scene.toml", beam(6, kStops, "end_time = 0.05\ntolerance = 1e-3\n"));
  const auto outcome = run_program({"run", "scene.toml"}, folder.path());
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_NE(outcome.output.find("chosen: exponential with tolerance 0.001"), std::string::npos) << outcome.output;
  EXPECT_NE(read_file(folder.file("scene-results/summary.json")).find("\"choice\": \"exponential with"),
            std::string::npos);
}

}  // namespace
}  // namespace butee::test::automatic_test
