#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>

#include "support/program.hpp"
#include "support/scene_run.hpp"

namespace butee::test::start_from_test {
namespace {

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// A moving beam and mass with stops and a load; `rest` is appended.
std::string scene(const std::string& rest, const std::string& elements = "4") {
  return R"(
schema = 1
[material.steel]
young_modulus = 2.0e11
density = 7900.0
[section.pipe]
shape = "tube"
outer_radius = 0.06
inner_radius = 0.04
[[element]]
type = "beam"
name = "string"
material = "steel"
section = "pipe"
length = 4.0
elements = )" +
         elements + R"(
[[element]]
type = "mass"
name = "disc"
node = "string:1"
mass = 20.0
[[support]]
nodes = ["string:first", "string:last"]
fix = ["u"]
[[contact]]
type = "stop"
nodes = "string:all"
gap = 1.0e-3
stiffness = 1.0e6
[[load]]
type = "harmonic"
node = "string:middle"
amplitude = 3000.0
angular_frequency = 70.0
[damping]
mass_proportional = 2.0
[output]
interval = 0.01
[[output.probe]]
label = "mid"
node = "string:middle"
quantities = ["u", "v", "theta"]
)" + rest;
}

std::string method(const std::string& type, const std::string& end_time) {
  return "[integrator]\ntype = \"" + type + "\"\ntime_step = 1e-4\nend_time = " + end_time + "\n" +
         (type == "newmark" ? "residual_tolerance = 1e-12\nincrement_tolerance = 1e-12\nmax_iterations = 30\n" : "");
}

class StartFrom : public ::testing::Test {
 protected:
  Outcome run(const std::string& name, const std::string& toml, const std::vector<std::string>& more = {}) {
    folder_.write(name + ".toml", toml);
    std::vector<std::string> arguments = {"run", name + ".toml", "-q"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(arguments, folder_.path());
  }
  void completes(const std::string& name, const std::string& toml) {
    const Outcome outcome = run(name, toml);
    ASSERT_EQ(outcome.status, 0) << outcome.errors;
  }
  CsvTable history(const std::string& name) const { return CsvTable(folder_.file(name + "-results/history.csv")); }
  void refused(const std::string& toml, const std::string& says) {
    const Outcome outcome = run("second", toml);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_TRUE(holds(outcome.errors, says)) << outcome.errors;
    EXPECT_FALSE(std::filesystem::exists(folder_.file("second-results")));
  }

  TemporaryFolder folder_;
};

const std::string kGoOn = "[initial]\nfrom = \"first-results\"\nkeep_time = true\n";

TEST_F(StartFrom, TwoHalvesAreOneRun) {
  // Rounding grows with every impact; the motion is 1e-2 m.
  constexpr double kRounding = 1e-9;
  for (const std::string type : {"exact", "rk4", "newmark", "newmark_modified"}) {
    completes("whole", scene(method(type, "0.4")));
    completes("first", scene(method(type, "0.2")));
    completes("second", scene(method(type, "0.4") + kGoOn));
    const auto whole = history("whole"), second = history("second");
    ASSERT_EQ(second.rows(), 21U) << type;
    EXPECT_EQ(second.column("t").front(), 0.2);
    EXPECT_EQ(second.column("t").back(), 0.4);
    for (const std::string column : {"mid.u", "mid.v", "mid.theta"}) {
      const auto one = whole.column(column), two = second.column(column);
      double largest = 0.0, worst = 0.0;
      for (std::size_t i = 0; i < two.size(); ++i) {
        largest = std::max(largest, std::abs(one[i + 20]));
        worst = std::max(worst, std::abs(two[i] - one[i + 20]));
      }
      EXPECT_GT(largest, 1e-5);
      EXPECT_LT(worst, kRounding * largest) << type << " " << column;
    }
  }
}

TEST_F(StartFrom, MethodsOfAToleranceGoOnWithinIt) {
  for (const std::string type : {"exponential", "rodas4", "dopri5"}) {
    completes("whole", scene(method("exact", "0.4")));
    completes("first", scene(method(type, "0.2")));
    completes("second", scene(method(type, "0.4") + kGoOn));
    const auto one = history("whole").column("mid.u"), two = history("second").column("mid.u");
    ASSERT_EQ(two.size(), 21U);
    for (std::size_t i = 0; i < two.size(); ++i) EXPECT_NEAR(two[i], one[i + 20], 1e-4) << type;
  }
}

/// A mass on a support that holds it by a stick spring against a constant force of 3 N; the limit is 5 N.
std::string held(const std::string& node, const std::string& rest) {
  return "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 1.0\n[[element]]\ntype = \"mass\"\nname = "
         "\"other\"\nmass = 1.0\n[[contact]]\ntype = \"friction\"\nnodes = \"" +
         node +
         "\"\ndof = \"u\"\nnormal_force = 10.0\nfriction = { coefficient = 0.5, stick_stiffness = 1e4, stick_damping = "
         "20.0 }\n[[load]]\ntype = \"constant\"\nnode = \"m\"\nvalue = 3.0\n[integrator]\ntype = "
         "\"dopri5\"\ntolerance = 1e-9\n" +
         rest + "[output]\nprobe = [{ label = \"mid\", node = \"m\", quantities = [\"u\"] }]\ninterval = 0.01\n";
}

TEST_F(StartFrom, SticksOnAsTheRunBeforeDid) {
  completes("whole", held("m", "end_time = 0.2\n"));
  completes("first", held("m", "end_time = 0.1\n") + "states = [0.055]\n");
  const auto whole = history("whole").column("mid.u");
  EXPECT_NEAR(whole.back(), 3.0 / 1e4, 1.5e-4);  // held by the spring, still swinging
  for (const std::string at : {"", "at = 0.055\n"}) {
    std::filesystem::remove_all(folder_.file("second-results"));
    completes("second", held("m", "end_time = 0.2\n" + kGoOn + at));
    const auto table = history("second");
    const auto t = table.column("t"), u = table.column("mid.u");
    for (std::size_t i = 0; i < table.rows(); ++i) {
      const double row = t[i] / 0.01;
      if (std::abs(row - std::round(row)) > 1e-6) continue;
      EXPECT_NEAR(u[i], whole[static_cast<std::size_t>(std::lround(row))], 1e-9) << at << t[i];
    }
  }
  const Outcome outcome = run("elsewhere", held("other", "end_time = 0.2\n" + kGoOn));
  EXPECT_EQ(outcome.status, 0);
  EXPECT_TRUE(holds(outcome.errors, "is a run with other contacts")) << outcome.errors;
}

TEST_F(StartFrom, TimeBeginsAnewUnlessItIsKept) {
  completes("first", scene(method("rk4", "0.2")));
  completes("second", scene(method("rk4", "0.1") + "[initial]\nfrom = \"first-results\"\n"));
  const auto first = history("first"), second = history("second");
  EXPECT_EQ(second.column("t").front(), 0.0);
  EXPECT_EQ(second.column("mid.u").front(), first.column("mid.u").back());
  EXPECT_EQ(second.column("mid.v").front(), first.column("mid.v").back());
}

TEST_F(StartFrom, TakesTheInstantThatIsAskedFor) {
  const auto kept = [](const std::string& rest) {
    std::string text = scene(rest);
    return text.replace(text.find("interval = 0.01"), 15, "interval = 0.01\nstates = [0.12, 0.05]");
  };
  completes("first", kept(method("rk4", "0.2")));
  const std::string from = "[initial]\nfrom = \"first-results\"\n";
  completes("second",
            scene(method("rk4", "0.1") + from + "at = 0.05\nvelocity = {nodes = \"string:1\", value = 0.5}\n"));
  EXPECT_EQ(history("second").column("mid.u")[0], history("first").column("mid.u")[5]);
  EXPECT_EQ(history("second").column("mid.theta")[0], history("first").column("mid.theta")[5]);
  std::filesystem::remove_all(folder_.file("second-results"));
  refused(scene(method("rk4", "0.1") + from + "at = 0.1\n"),
          "is not an instant saved by that run; saved: 0.05, 0.12, 0.2 s");
  refused(scene(method("rk4", "0.1") + kGoOn + "at = 0.12\n"),
          "begins the run at t = 0.12 s, and its end_time is 0.1 s");
}

TEST_F(StartFrom, RefusesOtherStructuresAndFolders) {
  completes("first", scene(method("rk4", "0.2")));
  refused(scene(method("rk4", "0.4") + kGoOn, "6"), "\"string\" has 5 nodes there and 7 here");
  std::string free_end = scene(method("rk4", "0.4") + kGoOn);
  free_end.replace(free_end.find(", \"string:last\"]"), 16, "]");
  refused(free_end, "is a run of another structure: u of string:4 is free here, not there");
  std::string longer = scene(method("rk4", "0.4") + kGoOn);
  longer.replace(longer.find("length = 4.0"), 12, "length = 5.0");
  refused(longer, "the nodes of \"string\" have other coordinates");
  refused(scene(method("rk4", "0.4") + "[initial]\nfrom = \"nowhere\"\n"),
          "name the result folder of a run that was completed");
  refused(scene(method("rk4", "0.4") + "[initial]\nat = 0.1\n"),
          "initial.at = 0.1: belongs to from, which is not given");
  const Outcome itself = run("second", scene(method("rk4", "0.4") + kGoOn), {"-o", "first-results"});
  EXPECT_EQ(itself.status, 2);
  EXPECT_TRUE(holds(itself.errors, "is the folder that the results of this run would replace")) << itself.errors;
  std::string damaged = read_file(folder_.file("first-results/states.bin"));
  damaged[damaged.size() / 2] ^= 1;
  folder_.write("first-results/states.bin", damaged);
  refused(scene(method("rk4", "0.4") + kGoOn), "is damaged: its checksum is wrong");
}

/// The saved motion would be overwritten by the static position.
TEST_F(StartFrom, RefusesAStaticStartBesideASavedMotion) {
  completes("first", scene(method("rk4", "0.2")));
  refused(scene(method("rk4", "0.4") + kGoOn + "[gravity]\nacceleration = [0.0, -9.81, 0.0]\nstatic = true\n"),
          "conflicts with [gravity] static, which starts at rest in the static position");
}

/// Motions are saved relative to the base, also by runs that compute them in space.
TEST_F(StartFrom, TakesMotionFromAnotherFrame) {
  const auto in = [](const std::string& frame, const std::string& end_time, const std::string& start) {
    std::string all = scene(method("exact", end_time) + start +
                            "[base]\ndisplacement = { direction = [0, 1, 0], type = \"harmonic\", amplitude = 1e-3, "
                            "angular_frequency = 70.0, phase = 0.3 }\n");
    return all.replace(all.find("gap = 1.0e-3"), 12, "gap = 1.0\nframe = \"" + frame + "\"");
  };
  completes("whole", in("base", "0.4", ""));
  const auto whole = history("whole");
  for (const std::string first : {"base", "space"})
    for (const std::string second : {"base", "space"}) {
      completes("first", in(first, "0.2", ""));
      completes("second", in(second, "0.4", kGoOn));
      const auto rest = history("second");
      for (const std::string column : {"mid.u", "mid.v"})
        for (const std::size_t i : {0U, 11U, 20U})
          EXPECT_NEAR(rest.column(column)[i], whole.column(column)[i + 20], column == "mid.u" ? 1e-11 : 1e-8)
              << first << " " << second << " " << column << " " << i;
    }
  std::string apart = in("base", "0.4", kGoOn);
  apart.replace(apart.find("[base]"), 6, "[[base]]\nnodes = \"string:first\"");
  apart.replace(apart.find("frame = \"base\""), 14, "");
  std::filesystem::remove_all(folder_.file("second-results"));
  refused(apart, "is a run whose motion is relative to a common [base]");
}

/// Where a support moves by itself, its motion begins anew too, unless the time is kept.
TEST_F(StartFrom, SaysThatASupportJumpsBack) {
  const auto moved = [](const std::string& rest) {
    return "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 1.0\n[[element]]\ntype = \"mass\"\nname = "
           "\"g\"\nmass = 1.0\n[[element]]\ntype = \"spring\"\nnodes = [\"m\", \"g\"]\nstiffness = "
           "100.0\n[[support]]\nnodes = \"g\"\nfix = [\"u\"]\n[[base]]\nnodes = \"g\"\ndisplacement = { direction = "
           "[0, 1, 0], type = \"table\", times = [0.0, 0.3, 0.5], values = [0.0, 0.1, 0.0] }\n[integrator]\ntype = "
           "\"exact\"\n" +
           rest + "[output]\nprobe = [{ label = \"mid\", node = \"m\", quantities = [\"u\"] }]\n";
  };
  for (const auto& [end_time, jumps] : {std::pair{"0.3", true}, std::pair{"0.5", false}}) {
    completes("first", moved("end_time = " + std::string(end_time) + "\n"));
    for (const bool keeps : {false, true}) {
      const std::string start = keeps ? kGoOn : "[initial]\nfrom = \"first-results\"\n";
      const Outcome outcome = run("second", moved("end_time = 1.0\n" + start));
      EXPECT_EQ(outcome.status, 0) << outcome.errors;
      EXPECT_EQ(holds(outcome.errors, "begin anew at t = 0"), jumps && !keeps) << outcome.errors;
    }
  }
}

TEST_F(StartFrom, ModelTomlFindsTheFolderAndNoticesAChange) {
  completes("first", scene(method("rk4", "0.2")));
  completes("second", scene(method("rk4", "0.4") + kGoOn));
  const std::string history = read_file(folder_.file("second-results/history.csv"));
  EXPECT_TRUE(holds(read_file(folder_.file("second-results/model.toml")), "from = \"../first-results\""));
  const auto again = [&] {
    return run_program({"run", "second-results/model.toml", "-o", "again", "-q"}, folder_.path());
  };
  EXPECT_EQ(again().status, 0);
  EXPECT_EQ(read_file(folder_.file("again/history.csv")), history);
  completes("first", scene(method("rk4", "0.15")));
  const Outcome changed = again();
  EXPECT_EQ(changed.status, 2);
  EXPECT_TRUE(holds(changed.errors, "states.bin there is not the file that the model was run with")) << changed.errors;
}

TEST_F(StartFrom, RigidRotationsAreStraightLines) {
  const std::string free = R"(schema = 1
[material.s]
young_modulus = 2e11
density = 8000.0
[section.r]
shape = "circle"
radius = 0.02
[[element]]
type = "beam"
name = "b"
material = "s"
section = "r"
coordinates = [0.0, 0.4, 1.0]
[[support]]
nodes = "b:first"
fix = ["u"]
[integrator]
type = "exact"
time_step = 1e-3
end_time = 0.1
[output]
interval = 0.1
[[output.probe]]
label = "tip"
node = "b:last"
quantities = ["u", "v", "theta", "theta_v"]
[initial]
displacement = { nodes = "b:all", rotation = 0.01, about = 0.0 }
velocity = { nodes = "b:all", rotation = -3.8, about = 0.0 }
)";
  completes("second", free);
  const auto rows = history("second");
  EXPECT_DOUBLE_EQ(rows.column("tip.u")[0], 0.01);
  EXPECT_DOUBLE_EQ(rows.column("tip.theta")[0], 0.01);
  EXPECT_DOUBLE_EQ(rows.column("tip.v")[0], -3.8);
  EXPECT_DOUBLE_EQ(rows.column("tip.theta_v")[0], -3.8);
  // A rod that turns about its pin does not bend.
  EXPECT_NEAR(rows.column("tip.u")[1], 0.01 - 0.38, 1e-9);
  EXPECT_NEAR(rows.column("tip.theta")[1], 0.01 - 0.38, 1e-9);
  std::filesystem::remove_all(folder_.file("second-results"));
  const auto with = [&](const std::string& find, const std::string& by) {
    std::string text = free;
    return text.replace(text.find(find), find.size(), by);
  };
  const std::string line = "rotation = -3.8, about = 0.0";
  refused(with(line, "rotation = -3.8"), "initial.velocity[0].about: missing; give the coordinate");
  refused(with(line, "about = 0.0, value = 1"), "initial.velocity[0].about = 0.0: belongs to rotation");
  refused(with(line, "rotation = 1, about = 0.5"), "u of b:0 is fixed by a [[support]]");
  refused(with(line, "rotation = 1, about = 0, dof = \"u\""), "conflicts with rotation, which sets u and theta");
  refused(with(line, "rotation = 1, about = 0, value = 1"), "conflicts with value; give one of the two");
}

}  // namespace
}  // namespace butee::test::start_from_test
