#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <sstream>

#include <gtest/gtest.h>

#include "support/program.hpp"
#include "support/scene_run.hpp"

namespace butee::test::matrices_file_test {
namespace {

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

const std::string kSymmetric = "%%MatrixMarket matrix coordinate real symmetric\n";

class MatricesFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_.write("m.mtx", kSymmetric + "2 2 2\n1 1 2.0\n2 2 3.0\n");
    folder_.write("k.mtx", kSymmetric + "2 2 3\n1 1 200.0\n2 1 -50.0\n2 2 300.0\n");
  }
  Outcome run(const std::string& keys, const std::string& node = "two:0") {
    folder_.write("s.toml",
                  "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"ball\"\nmass = 1.0\n[[element]]\ntype = "
                  "\"matrices\"\nname = \"two\"\n" +
                      keys + "\n[[load]]\ntype = \"constant\"\nnode = \"" + node +
                      "\"\nvalue = 1.0\n[integrator]\ntype = \"newmark\"\ntime_step = 1e-3\nend_time = 0.1\n");
    return run_program({"run", "s.toml", "-q"}, folder_.path());
  }
  void refused(const std::string& keys, const std::string& says) {
    const Outcome outcome = run(keys);
    EXPECT_EQ(outcome.status, 2) << keys;
    EXPECT_TRUE(holds(outcome.errors, says)) << outcome.errors;
    EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 1) << outcome.errors;
    EXPECT_FALSE(std::filesystem::exists(folder_.file("s-results"))) << keys;
  }

  TemporaryFolder folder_;
  const std::string files_ = "mass = \"m.mtx\"\nstiffness = \"k.mtx\"\n";
};

TEST_F(MatricesFile, MistakesAreSaidWithTheirLine) {
  refused("mass = \"none.mtx\"\nstiffness = \"k.mtx\"\nnodes = [\"two:0..1\"]\ndofs = \"u\"",
          "s.toml:9: element[1].mass = \"none.mtx\": does not exist");
  folder_.write("bad.mtx", kSymmetric + "2 2 2\n1 1 2.0\n2 2 x\n");
  refused("mass = \"m.mtx\"\nstiffness = \"bad.mtx\"\ndofs = \"u\"",
          "s.toml:10: element[1].stiffness = \"bad.mtx\": bad.mtx:4: the value of entry (2, 2): \"x\" is not a number");
  folder_.write("large.mtx", kSymmetric + "3 3 1\n1 1 2.0\n");
  refused("mass = \"m.mtx\"\nstiffness = \"large.mtx\"\ndofs = \"u\"", "has 3 rows, and mass has 2");
  folder_.write("general.mtx", "%%MatrixMarket matrix coordinate real general\n2 2 3\n1 1 2\n2 2 3\n1 2 0.5\n");
  refused("mass = \"general.mtx\"\nstiffness = \"k.mtx\"\ndofs = \"u\"",
          "element[1].mass = \"general.mtx\": is not symm");
  refused(files_ + "gyroscopic = \"general.mtx\"\ndofs = \"u\"", "is not skew-symmetric");
  folder_.write("negative.mtx", kSymmetric + "2 2 2\n1 1 2.0\n2 2 -3.0\n");
  refused("mass = \"negative.mtx\"\nstiffness = \"k.mtx\"\ndofs = \"u\"", "negative entry on the diagonal, in row 2");
}

TEST_F(MatricesFile, RowsThatDoNotFitAreSaid) {
  refused(files_ + "dofs = [\"u\", \"theta\", \"uz\"]", "names 3 degrees of freedom of each node, and mass has 2 rows");
  refused(files_ + "dofs = [\"u\", \"uy\"]", "names uy twice");
  refused(files_ + "dofs = [\"uy\", \"q\"]",
          "element[1].dofs = [\"uy\", \"q\"]: names \"q\", which is not a degree of freedom");
  refused(files_ + "dofs = \"u\"\nnodes = [\"two:0\", \"ball\", \"two:1\"]", "names 3 rows with the nodes");
  refused(files_ + "dofs = \"u\"\nnodes = [\"two:0\", \"bal\"]",
          "there is no node or beam \"bal\" (did you mean \"ball\"?)");
  refused(files_ + "dofs = \"u\"\ncoordinates = [0.0, 1.0, 2.0]", "holds 3 numbers; the element has 2 nodes");
  refused(files_ + "dofs = \"rows.txt\"", "element[1].dofs = \"rows.txt\": does not exist");
  folder_.write("rows.txt", "# node dof\n0 u\n1 v\n");
  refused(files_ + "dofs = \"rows.txt\"", "rows.txt:3: \"v\" is not a degree of freedom");
  folder_.write("rows.txt", "0 u\n1\n");
  refused(files_ + "dofs = \"rows.txt\"", "rows.txt:2: must hold a node and a degree of freedom");
  folder_.write("rows.txt", "0 u\n0 uy\n");
  refused(files_ + "dofs = \"rows.txt\"", "rows.txt:2: this degree of freedom was named in line 1 before");
  folder_.write("rows.txt", "0 u\nbal u\n");
  refused(files_ + "dofs = \"rows.txt\"", "rows.txt:2: \"bal\": there is no node or beam \"bal\"");
  folder_.write("rows.txt", "0 u\n");
  refused(files_ + "dofs = \"rows.txt\"", "names 1 rows, and mass has 2");
  refused(files_ + "dofs = \"rows.txt\"\nnodes = [\"two:0\"]", "conflicts with a file of dofs");
}

TEST_F(MatricesFile, AreNamedInModelTomlAndFoundFromThere) {
  folder_.write("rows.txt", "two:0, u\nball, u\n");
  const std::string keys = files_ + "dofs = \"rows.txt\"";
  ASSERT_EQ(run(keys).status, 0) << run(keys).errors;
  const std::string history = read_file(folder_.file("s-results/history.csv"));
  const auto again = [&] { return run_program({"run", "s-results/model.toml", "-o", "again", "-q"}, folder_.path()); };
  const Outcome outcome = again();
  ASSERT_EQ(outcome.status, 0) << outcome.errors << read_file(folder_.file("s-results/model.toml"));
  EXPECT_EQ(read_file(folder_.file("again/history.csv")), history);
  for (const char* command : {"check", "modes"})
    EXPECT_EQ(run_program({command, "s.toml"}, folder_.path()).status, 0) << command;
  folder_.write("k.mtx", kSymmetric + "2 2 3\n1 1 201.0\n2 1 -50.0\n2 2 300.0\n");
  const Outcome changed = again();
  EXPECT_EQ(changed.status, 2);
  EXPECT_TRUE(holds(changed.errors, "stiffness = \"../k.mtx\": is not the file that the model was run with"))
      << changed.errors;
}

/// x = v/omega sinh(omega t) for a stiffness of -1000 N/m on 2 kg: no mode of a structure at rest.
/// A node that moves along x alone has its contact force there: k (gap - |x|) towards the middle.
TEST_F(MatricesFile, ContactForceIsAlongTheOnlyDirectionOfANode) {
  folder_.write("s.toml",
                "schema = 1\n[[element]]\ntype = \"matrices\"\nname = \"two\"\n" + files_ +
                    "dofs = \"ux\"\n[[contact]]\ntype = \"stop\"\nnodes = \"two:0\"\ndof = \"ux\"\ngap = "
                    "0.01\nstiffness = 1e4\n[initial]\nvelocity = [{ nodes = \"two:0\", dof = \"ux\", value = 1.0 "
                    "}]\n[integrator]\nend_time = 0.2\n[[output.probe]]\nnode = \"two:0\"\nquantities = [\"ux\", "
                    "\"contact_force\"]\n");
  const Outcome outcome = run_program({"run", "s.toml", "-q", "-o", "out"}, folder_.path());
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  std::istringstream rows(read_file(folder_.file("out/history.csv")));
  std::string row;
  std::getline(rows, row);
  double largest = 0.0;
  while (std::getline(rows, row)) {
    double t = 0.0, x = 0.0, force = 0.0;
    ASSERT_EQ(std::sscanf(row.c_str(), "%lf,%lf,%lf", &t, &x, &force), 3) << row;
    EXPECT_NEAR(force, -std::copysign(1e4 * std::max(std::abs(x) - 0.01, 0.0), x), 1e-9) << "t = " << t;
    largest = std::max(largest, std::abs(force));
  }
  EXPECT_GT(largest, 100.0);
}

TEST_F(MatricesFile, OfAnUnstableStructureHaveNoModes) {
  folder_.write("unstable.mtx", kSymmetric + "2 2 2\n1 1 -1000.0\n2 2 3e5\n");
  const auto scene = [](const std::string& type) {
    return "schema = 1\n[[element]]\ntype = \"matrices\"\nname = \"two\"\nmass = \"m.mtx\"\nstiffness = "
           "\"unstable.mtx\"\ndofs = \"u\"\n[initial]\nvelocity = [{ nodes = \"two:0\", value = 0.5 "
           "}]\n[integrator]\ntype = "
           "\"" +
           type + "\"\nend_time = 0.1\n[[output.probe]]\nlabel = \"p\"\nnode = \"two:0\"\nquantities = [\"u\"]\n";
  };
  folder_.write("s.toml", scene("auto"));
  const Outcome modes = run_program({"modes", "s.toml"}, folder_.path());
  EXPECT_EQ(modes.status, 2);
  EXPECT_TRUE(holds(modes.errors, "negative eigenvalue -500 1/s2")) << modes.errors;
  const double omega = std::sqrt(500.0), wanted = 0.5 / omega * std::sinh(omega * 0.1);
  for (const char* method : {"auto", "exponential", "rodas4", "exact"}) {
    folder_.write("s.toml", scene(method));
    const Outcome outcome = run_program({"run", "s.toml"}, folder_.path());
    ASSERT_EQ(outcome.status, 0) << outcome.errors;
    if (std::string(method) == "auto") {
      EXPECT_TRUE(holds(outcome.output, "damped modes, since the stiffness has a negative eigenvalue"))
          << outcome.output;
    }
    const std::string history = read_file(folder_.file("s-results/history.csv")),
                      last = history.substr(history.rfind('\n', history.size() - 2) + 1);
    EXPECT_NEAR(std::stod(last.substr(last.find(',') + 1)), wanted, 1e-3 * wanted) << method;
  }
}

}  // namespace
}  // namespace butee::test::matrices_file_test
