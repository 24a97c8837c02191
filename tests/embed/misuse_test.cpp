// Invalid calls: each is refused with a message and changes nothing. After a failed step the structure can
// continue.
#include <butee/embed/butee.h>
#include <cmath>
#include <functional>
#include <limits>

#include <butee/core/error.hpp>
#include <butee/embed/structure.hpp>
#include <gtest/gtest.h>

#include "support/program.hpp"
#include "support/scene_run.hpp"

namespace butee::test::misuse_test {
namespace {

using embed::Structure;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Two masses; one of them strikes a stop.
std::string scene(const std::string& integrator, const std::string& mass = "2.0") {
  return R"(schema = 1
[[element]]
type = "mass"
name = "m"
mass = )" +
         mass + R"(
[[element]]
type = "spring"
node = "m"
stiffness = 800.0
damping = 1.5
[[element]]
type = "mass"
name = "n"
mass = 1.0
[[contact]]
type = "stop"
nodes = "m"
gap = 0.01
law = "linear"
stiffness = 1e6
[integrator]
)" + integrator;
}

const std::string kAuto = "type = \"exponential\"\ntolerance = 1e-8\n";

Structure structure(const std::string& toml) {
  return Structure::from_toml(toml, {.plugins = {BUTEE_TEST_PLUGINS}, .forced = {"m"}});
}

struct Misuse {
  const char* name;
  std::function<void(Structure&)> call;
  const char* says;
};

std::vector<Misuse> misuses() {
  const auto both = [](double x) { return Vector(Vector::Constant(2, x)); };
  std::vector<Misuse> all = {
      {"advance_to(inf)", [](Structure& s) { s.advance_to(kInfinity); }, "advance_to = inf s: the time must be finite"},
      {"advance_to(nan)", [](Structure& s) { s.advance_to(kNaN); }, "must be finite and not before the present one"},
      {"advance_to(back)", [](Structure& s) { s.advance_to(0.001); }, "only restore() goes back"},
      {"advance_step(inf)", [](Structure& s) { s.advance_step(kInfinity); }, "the time must be finite and after"},
      {"advance_step(now)", [](Structure& s) { s.advance_step(s.time()); }, "after the present one, 0.002 s"},
      {"dof_name", [](Structure& s) { s.dof_name(2); }, "the degree of freedom 2 does not exist; there are 0 to 1"},
      {"displacement", [](Structure& s) { s.displacement(-1); }, "the degree of freedom -1 does not exist"},
      {"velocity", [](Structure& s) { s.velocity(2); }, "does not exist"},
      {"acceleration", [](Structure& s) { s.acceleration(9); }, "does not exist"},
      {"contact_force", [](Structure& s) { s.contact_force(2); }, "does not exist"},
      {"set_displacement(dof)", [](Structure& s) { s.set_displacement(2, 0.0); }, "does not exist"},
      {"set_motion(size)", [&](Structure& s) { s.set_motion(Vector::Zero(3), Vector::Zero(2)); },
       "a displacement: 3 numbers are given for 2 degrees of freedom"},
      {"until now", [](Structure& s) { s.set_force(0, 0.0, 1.0, s.time()); }, "set_force until = 0.002 s"},
      {"until inf", [](Structure& s) { s.set_force(0, 0.0, 1.0, kInfinity); }, "set_force until = inf s"},
      {"steep", [](Structure& s) { s.set_force(0, 0.0, 1e99, std::nextafter(s.time(), 1.0)); }, "the slope of a force"},
      {"no snapshot", [](Structure& s) { s.restore({}); }, "the snapshot is of another structure"},
      {"fewer forces",
       [](Structure& s) {
         Structure::Snapshot snapshot = s.snapshot();
         snapshot.forces.clear();
         s.restore(snapshot);
       },
       "the snapshot has 0 forces; the structure has 1"},
  };
  for (const double bad : {kNaN, kInfinity, -kInfinity, 1e300, -1e300}) {
    all.push_back({"x", [=](Structure& s) { s.set_motion(both(bad), both(0.0)); }, "a displacement is "});
    all.push_back({"v", [=](Structure& s) { s.set_motion(both(0.0), both(bad)); }, "a velocity is "});
    all.push_back({"x of one", [=](Structure& s) { s.set_displacement(0, bad); }, "a finite number of at most 1e+100"});
    all.push_back({"v of one", [=](Structure& s) { s.set_velocity(1, bad); }, "a velocity is "});
    all.push_back({"force", [=](Structure& s) { s.set_force(0, bad); }, "a force is "});
    all.push_back({"from", [=](Structure& s) { s.set_force(0, bad, 0.0, 1.0); }, "a force is "});
    all.push_back({"to", [=](Structure& s) { s.set_force(0, 0.0, bad, 1.0); }, "a force is "});
  }
  return all;
}

TEST(Misuse, IsRefusedAndChangesNothing) {
  Structure used = structure(scene(kAuto)), spared = structure(scene(kAuto));
  for (Structure* one : {&used, &spared}) {
    one->set_force(0, 30.0);
    one->advance_to(0.002);
  }
  for (const Misuse& misuse : misuses()) {
    try {
      misuse.call(used);
      ADD_FAILURE() << misuse.name << " passed";
    } catch (const LogicError& error) {
      EXPECT_NE(std::string(error.what()).find(misuse.says), std::string::npos) << misuse.name << ": " << error.what();
    }
  }
  EXPECT_THROW(used.set_force(1, 1.0), InputError);
  for (Structure* one : {&used, &spared}) one->advance_to(0.1);
  EXPECT_TRUE(used.state().x == spared.state().x);
  EXPECT_TRUE(used.state().v == spared.state().v);
}

/// An observer is called with a step whose end is not yet the state: forces may change between steps only. A step at
/// which an observer throws is taken again, and counted once.
TEST(Misuse, OfAnObserverIsRefused) {
  class Calling final : public time::Observer {
   public:
    explicit Calling(std::function<void()> call) : call_(std::move(call)) {}
    void step(const time::AcceptedStep&) override { call_(); }

   private:
    std::function<void()> call_;
  };
  Structure used = structure(scene("type = \"rk4\"\ntime_step = 1e-3\n")),
            spared = structure(scene("type = \"rk4\"\ntime_step = 1e-3\n"));
  int refused = 0, calls = 0;
  Calling changing([&] {
    try {
      used.set_force(0, 100.0);
    } catch (const LogicError&) {
      ++refused;
    }
  });
  Calling throwing([&] {
    if (++calls == 3) throw RunError("no more");
  });
  used.observe(changing);
  used.observe(throwing);
  EXPECT_THROW(used.advance_to(0.1), RunError);
  EXPECT_EQ(used.report().steps, 2);
  used.advance_to(0.1);
  spared.advance_to(0.1);
  EXPECT_EQ(refused, 101);
  EXPECT_EQ(used.report().steps, 100);
  EXPECT_EQ(used.force(0), 0.0);
  EXPECT_TRUE(used.state().x == spared.state().x);
  EXPECT_THROW(used.follow_peaks("m", {model::Quantity::uz}), InputError);
}

TEST(Misuse, OfAStructureThatWasMovedFromIsRefused) {
  Structure old = structure(scene(kAuto));
  const Structure kept = std::move(old);
  EXPECT_EQ(kept.size(), 2);
  EXPECT_THROW(old.size(), LogicError);  // NOLINT(bugprone-use-after-move)
  EXPECT_THROW(old.advance_to(1.0), LogicError);
}

/// advance_to() calls a function after each step. That function must not change the state; if it tries to, advance_to()
/// still reaches its time.
TEST(Misuse, OfTheFunctionThatIsAskedIsRefused) {
  Structure used = structure(scene("type = \"dopri5\"\ntolerance = 1e-6\n"));
  const Structure::Snapshot snapshot = used.snapshot();
  used.set_force(0, 30.0);
  const std::vector<std::function<void()>> calls = {[&] { used.restore(snapshot); }, [&] { used.advance_to(1.0); },
                                                    [&] { used.advance_step(1.0); },
                                                    [&] { used.set_motion(Vector::Zero(2), Vector::Zero(2)); }};
  double end = 0.0;
  for (const auto& call : calls) {
    int refused = 0;
    const bool has_reached = used.advance_to(end += 0.05, [&] {
      try {
        call();
      } catch (const LogicError&) {
        ++refused;
      }
      return true;
    });
    EXPECT_TRUE(has_reached);
    EXPECT_EQ(used.time(), end);
    EXPECT_GT(refused, 0);
  }
  used.restore(snapshot);
  EXPECT_EQ(used.time(), 0.0);
  EXPECT_THROW(used.quantity("u", "m", "n"), InputError);
}

TEST(Misuse, ASnapshotOfAnotherStructureIsRefused) {
  const Structure::Snapshot snapshot = structure(scene(kAuto)).snapshot();
  Structure heavier = structure(scene(kAuto, "2.5"));
  EXPECT_THROW(heavier.restore(snapshot), LogicError);
  Structure elsewhere = Structure::from_toml(scene(kAuto), {.plugins = {BUTEE_TEST_PLUGINS}, .forced = {"n"}});
  EXPECT_THROW(elsewhere.restore(snapshot), LogicError);
  Structure watched = structure(scene(kAuto));
  Peak peak(0);
  watched.observe(peak);
  EXPECT_THROW(watched.restore(snapshot), LogicError);
  Structure of_u = structure(scene(kAuto)), of_v = structure(scene(kAuto));
  of_u.follow_peaks("m", {model::Quantity::u});
  of_v.follow_peaks("m", {model::Quantity::v});
  of_u.advance_to(0.01);
  EXPECT_THROW(of_v.restore(of_u.snapshot()), LogicError);
  Structure equal = structure(scene(kAuto));
  equal.advance_to(0.01);
  equal.restore(snapshot);
  EXPECT_EQ(equal.time(), 0.0);
}

/// Scenes with the same text beside files with other contents.
TEST(Misuse, ASnapshotBesideAnotherFileIsRefused) {
  const TemporaryFolder one, other, same;
  const std::string loaded = scene(kAuto) + "[[load]]\ntype = \"table\"\nnode = \"n\"\nfile = \"load.csv\"\n";
  for (const auto& [folder, force] : {std::pair(&one, "1.0"), std::pair(&other, "2.0"), std::pair(&same, "1.0")}) {
    folder->write("scene.toml", loaded);
    folder->write("load.csv", "t,f\n0,0\n1," + std::string(force) + "\n");
  }
  const auto structure_in = [](const TemporaryFolder& folder) {
    return Structure::from_file(folder.file("scene.toml"), {.plugins = {BUTEE_TEST_PLUGINS}});
  };
  Structure first = structure_in(one), second = structure_in(other), third = structure_in(same);
  first.advance_to(0.01);
  EXPECT_THROW(second.restore(first.snapshot()), LogicError);
  third.restore(first.snapshot());
  EXPECT_EQ(third.time(), 0.01);
}

/// Peaks that record::Peaks does not follow, and peaks that are asked for too late, are refused and not there
/// afterwards.
TEST(Misuse, PeaksThatAreNotFollowedAreRefused) {
  const std::string damped =
      "[[contact]]\ntype = \"stop\"\nnodes = \"n\"\ngap = 0.01\nlaw = \"linear\"\nstiffness = 1e6\n"
      "damping = { type = \"kelvin_voigt\", coefficient = 10.0 }\n[integrator]\n";
  std::string text = scene(kAuto);
  text.replace(text.find("[integrator]\n"), std::string("[integrator]\n").size(), damped);
  Structure body = structure(text);
  EXPECT_THROW(body.follow_peaks("n", {model::Quantity::contact_force}), InputError);
  EXPECT_NO_THROW(body.follow_peaks("n", {model::Quantity::u}));
  body.advance_to(0.01);
  EXPECT_ANY_THROW(body.follow_peaks("n", {model::Quantity::v}));
  EXPECT_ANY_THROW(body.peak("n", model::Quantity::v));
  EXPECT_NO_THROW(body.peak("n", model::Quantity::u));
}

/// h omega = 4 of rk4: any motion grows until the run is stopped.
const std::string kUnstable = "type = \"rk4\"\ntime_step = 0.2\n";

TEST(AfterAFailedStep, AnotherMotionGoesOn) {
  Structure mass = structure(scene(kUnstable));
  mass.set_force(0, 1.0);
  EXPECT_THROW(mass.advance_to(100.0), RunError);
  const double failed_at = mass.time();
  EXPECT_THROW(mass.advance_to(100.0), RunError) << "nothing was changed";
  EXPECT_EQ(mass.time(), failed_at);
  mass.set_force(0, 0.0);
  mass.set_motion(Vector::Zero(2), Vector::Zero(2));
  mass.advance_to(200.0);
  EXPECT_EQ(mass.time(), 200.0);
  EXPECT_TRUE(mass.report().completed);
  EXPECT_EQ(mass.displacement(0), 0.0);
}

/// An absolute tolerance under an extreme force: the step falls to its lower limit; with a moderate force the
/// run then continues normally.
TEST(AfterAFailedStep, AnotherForceGoesOn) {
  const std::string keys = "type = \"rk4_error_scaled\"\ntime_step = 1e-4\ntolerance = 1e-7\nsafety = 0.9\n";
  Structure mass = structure(scene(keys)), spared = structure(scene(keys));
  mass.set_force(0, 1e99);
  EXPECT_THROW(mass.advance_to(0.1), RunError);
  for (Structure* one : {&mass, &spared}) {
    one->set_force(0, 30.0);
    one->advance_to(0.1);
  }
  EXPECT_TRUE(mass.report().completed);
  EXPECT_NE(mass.displacement(0), 0.0);
  EXPECT_EQ(mass.displacement(0), spared.displacement(0));
  EXPECT_EQ(mass.report().steps, spared.report().steps);
}

TEST(AfterAFailedStep, TheNextFailureHasItsOwnMessage) {
  Structure mass = structure(scene(kUnstable));
  const auto failure = [&] {
    try {
      mass.advance_to(1e3);
    } catch (const RunError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  mass.set_force(0, 1.0);
  const std::string first = failure();
  mass.set_motion(Vector::Zero(2), Vector::Zero(2));
  const std::string second = failure();
  EXPECT_FALSE(first.empty() || second.empty());
  EXPECT_NE(first, second);
}

/// The same in C, where all these errors return one status.
TEST(MisuseInC, IsRefusedWithItsStatus) {
  setenv("BUTEE_PLUGIN_PATH", BUTEE_TEST_PLUGINS, 1);
  butee_structure *mass = nullptr, *other = nullptr;
  ASSERT_EQ(butee_open_text(scene(kAuto).c_str(), "m", &mass), BUTEE_OK) << butee_message();
  ASSERT_EQ(butee_open_text(scene(kAuto, "3.0").c_str(), "m", &other), BUTEE_OK) << butee_message();
  butee_snapshot* snapshot = nullptr;
  ASSERT_EQ(butee_save(other, &snapshot), BUTEE_OK);
  ASSERT_EQ(butee_advance_to(mass, 0.002), BUTEE_OK);
  double t = 0.0;
  const double still[2] = {0.0, 0.0};
  const auto refused = [](int status, const std::string& says) {
    EXPECT_EQ(status, BUTEE_BAD_CALL);
    EXPECT_NE(std::string(butee_message()).find(says), std::string::npos) << butee_message();
    EXPECT_EQ(std::string(butee_message()).find("butee needs"), std::string::npos);
  };
  for (const double bad : {kNaN, kInfinity, -kInfinity, 1e300}) {
    const double wrong[2] = {0.0, bad};
    refused(butee_set_motion(mass, 2, wrong, still), "a displacement is ");
    refused(butee_set_motion(mass, 2, still, wrong), "a velocity is ");
    refused(butee_set_force(mass, 0, bad), "a force is ");
    refused(butee_set_force_line(mass, 0, bad, 0.0, 1.0), "a force is ");
    refused(butee_set_force_line(mass, 0, 0.0, bad, 1.0), "a force is ");
  }
  for (const double bad : {kNaN, kInfinity, 0.001}) {
    refused(butee_advance_to(mass, bad), "the time must be finite and not before the present one, 0.002 s");
    refused(butee_advance_step(mass, bad, &t), "the time must be finite and after the present one, 0.002 s");
    refused(butee_set_force_line(mass, 0, 0.0, 1.0, bad), "the time must be finite and after");
  }
  refused(butee_restore(mass, snapshot), "the snapshot is of another structure");
  refused(butee_restore(mass, nullptr), "a pointer is null");
  refused(butee_set_force(nullptr, 0, 1.0), "a pointer is null");
  refused(butee_set_force(mass, 2, 1.0), "the degree of freedom 2 does not exist; there are 0 to 1");
  refused(butee_set_motion(mass, 1, still, still), "the arrays have 1 numbers; the structure has 2 degrees of freedom");
  ASSERT_EQ(butee_time(mass, &t), BUTEE_OK);
  EXPECT_EQ(t, 0.002);
  EXPECT_EQ(butee_advance_to(mass, 0.01), BUTEE_OK) << butee_message();
  butee_free_snapshot(snapshot);
  butee_close(other);
  butee_close(mass);
}

TEST(MisuseInC, AFailedStepIsNoDeadEnd) {
  setenv("BUTEE_PLUGIN_PATH", BUTEE_TEST_PLUGINS, 1);
  butee_structure* mass = nullptr;
  ASSERT_EQ(butee_open_text(scene(kUnstable).c_str(), "m", &mass), BUTEE_OK) << butee_message();
  ASSERT_EQ(butee_set_force(mass, 0, 1.0), BUTEE_OK);
  EXPECT_EQ(butee_advance_to(mass, 100.0), BUTEE_RUN_FAILED);
  EXPECT_NE(std::string(butee_message()).find("t = "), std::string::npos) << butee_message();
  const double still[2] = {0.0, 0.0};
  ASSERT_EQ(butee_set_force(mass, 0, 0.0), BUTEE_OK);
  ASSERT_EQ(butee_set_motion(mass, 2, still, still), BUTEE_OK);
  EXPECT_EQ(butee_advance_to(mass, 200.0), BUTEE_OK) << butee_message();
  butee_close(mass);
}

}  // namespace
}  // namespace butee::test::misuse_test
