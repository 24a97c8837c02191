#include <array>
#include <butee/embed/butee.h>
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "support/scene_run.hpp"

namespace butee::test::c_interface_test {
namespace {

/// A free mass of 2 kg with an initial velocity towards a stop 10 mm away.
const char* const kScene =
    "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 2.0\n"
    "[[contact]]\ntype = \"stop\"\nnodes = \"m\"\nsides = \"positive\"\ngap = 0.01\nlaw = \"linear\"\nstiffness = 1e5\n"
    "[initial]\nvelocity = [{nodes = \"m\", value = 1.0}]\n[integrator]\ntolerance = 1e-8\n";

class CInterface : public testing::Test {
 protected:
  void SetUp() override {
    setenv("BUTEE_PLUGIN_PATH", BUTEE_TEST_PLUGINS, 1);
    ASSERT_EQ(butee_open_text(kScene, "m", &mass_), BUTEE_OK) << butee_message();
    ASSERT_EQ(butee_dof(mass_, "m", BUTEE_U, &dof_), BUTEE_OK);
  }
  void TearDown() override { butee_close(mass_); }

  butee_structure* mass_ = nullptr;
  int64_t dof_ = -1;
};

TEST_F(CInterface, AdvancesReadsAndGoesBack) {
  int64_t size = 0;
  ASSERT_EQ(butee_size(mass_, &size), BUTEE_OK);
  EXPECT_EQ(size, 1);
  double t = -1.0, u = 0.0, v = 0.0, a = 0.0;
  ASSERT_EQ(butee_advance_to(mass_, 0.009), BUTEE_OK);
  ASSERT_EQ(butee_motion(mass_, dof_, &u, &v, nullptr), BUTEE_OK);
  EXPECT_NEAR(u, 0.009, 1e-15);
  butee_snapshot* snapshot = nullptr;
  ASSERT_EQ(butee_save(mass_, &snapshot), BUTEE_OK);
  // Half a period of the mass on its stop later, it moves back.
  ASSERT_EQ(butee_advance_to(mass_, 0.03), BUTEE_OK);
  ASSERT_EQ(butee_motion(mass_, dof_, nullptr, &v, nullptr), BUTEE_OK);
  EXPECT_NEAR(v, -1.0, 1e-6);
  ASSERT_EQ(butee_restore(mass_, snapshot), BUTEE_OK);
  butee_free_snapshot(snapshot);
  ASSERT_EQ(butee_time(mass_, &t), BUTEE_OK);
  EXPECT_EQ(t, 0.009);

  ASSERT_EQ(butee_set_force(mass_, dof_, 4.0), BUTEE_OK);
  ASSERT_EQ(butee_all_motion(mass_, 1, &u, &v, &a), BUTEE_OK);
  EXPECT_NEAR(a, 2.0, 1e-14);
  const double there = 0.012, still = 0.0;
  ASSERT_EQ(butee_set_motion(mass_, 1, &there, &still), BUTEE_OK);
  double force = 0.0, kinetic = 0.0, strain = 0.0, contact = 0.0;
  ASSERT_EQ(butee_contact_force(mass_, dof_, &force), BUTEE_OK);
  EXPECT_NEAR(force, -200.0, 1e-9);
  ASSERT_EQ(butee_energy(mass_, &kinetic, &strain, &contact), BUTEE_OK);
  EXPECT_NEAR(contact, 0.5 * 1e5 * 4e-6, 1e-12);
  EXPECT_EQ(kinetic + strain, 0.0);
  ASSERT_EQ(butee_set_force_line(mass_, dof_, 4.0, 0.0, 1.0), BUTEE_OK);
  ASSERT_EQ(butee_advance_step(mass_, 0.1, &t), BUTEE_OK);
  EXPECT_GT(t, 0.009);
}

TEST_F(CInterface, GivesQuantitiesByNameAndTheirPeaks) {
  butee_structure* pair = nullptr;
  ASSERT_EQ(butee_open_text("schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 2.0\n"
                            "[[element]]\ntype = \"spring\"\nname = \"soft\"\nnode = \"m\"\nstiffness = 300.0\n"
                            "[[element]]\ntype = \"spring\"\nname = \"hard\"\nnode = \"m\"\nstiffness = 500.0\n"
                            "[integrator]\ntype = \"exact\"\n",
                            nullptr, &pair),
            BUTEE_OK)
      << butee_message();
  ASSERT_EQ(butee_follow_peak(pair, "m", "v"), BUTEE_OK) << butee_message();
  // Peaks of element forces cannot be tracked.
  EXPECT_EQ(butee_follow_peak(pair, "m", "spring_force"), BUTEE_BAD_INPUT);
  EXPECT_NE(std::strstr(butee_message(), "spring_force"), nullptr) << butee_message();
  const double u = 0.01, v = 0.0;
  ASSERT_EQ(butee_set_motion(pair, 1, &u, &v), BUTEE_OK);
  double value = 0.0;
  ASSERT_EQ(butee_quantity(pair, "spring_force", "m", nullptr, &value), BUTEE_OK) << butee_message();
  EXPECT_DOUBLE_EQ(value, -8.0);
  ASSERT_EQ(butee_quantity(pair, "spring_force", "m", "hard", &value), BUTEE_OK);
  EXPECT_DOUBLE_EQ(value, -5.0);
  ASSERT_EQ(butee_quantity(pair, "a", "m", "", &value), BUTEE_OK);
  EXPECT_DOUBLE_EQ(value, -4.0);
  // u = 0.01 cos(20 t)
  ASSERT_EQ(butee_advance_to(pair, 1.0), BUTEE_OK) << butee_message();
  ASSERT_EQ(butee_quantity(pair, "spring_force", "m", "soft", &value), BUTEE_OK);
  EXPECT_NEAR(value, -3.0 * std::cos(20.0), 1e-9);
  ASSERT_EQ(butee_peak(pair, "m", "v", &value), BUTEE_OK) << butee_message();
  EXPECT_NEAR(value, 0.2, 1e-9);
  value = 7.0;
  EXPECT_EQ(butee_quantity(pair, "M", "m", nullptr, &value), BUTEE_BAD_INPUT);
  EXPECT_EQ(butee_quantity(pair, "spring_forces", "m", nullptr, &value), BUTEE_BAD_INPUT);
  EXPECT_EQ(butee_quantity(pair, "spring_force", "nobody", nullptr, &value), BUTEE_BAD_INPUT);
  EXPECT_EQ(butee_quantity(pair, nullptr, "m", nullptr, &value), BUTEE_BAD_CALL);
  EXPECT_EQ(butee_quantity(nullptr, "u", "m", nullptr, &value), BUTEE_BAD_CALL);
  EXPECT_EQ(value, 7.0);
  butee_close(pair);
}

/// A body with springs along x, y and z and about y and z: x = F/k (1 - cos(w t)) for each.
TEST_F(CInterface, NamesEveryDegreeOfFreedom) {
  std::string scene =
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 2.0\nrotary_inertia = 0.5\n"
      "[integrator]\ntype = \"exact\"\n";
  const std::pair<const char*, int> kinds[] = {
      {"ux", BUTEE_UX}, {"uy", BUTEE_UY}, {"uz", BUTEE_UZ}, {"ry", BUTEE_RY}, {"rz", BUTEE_RZ}};
  double stiffness = 100.0;
  std::string forced;
  for (const auto& [name, kind] : kinds) {
    scene += std::string("[[element]]\ntype = \"spring\"\nnode = \"m\"\ndof = \"") + name +
             "\"\nstiffness = " + std::to_string(stiffness *= 2.0) + "\n";
    forced += std::string(" m.") + name;
  }
  butee_structure* body = nullptr;
  ASSERT_EQ(butee_open_text(scene.c_str(), forced.c_str(), &body), BUTEE_OK) << butee_message();
  ASSERT_EQ(butee_follow_peak(body, "m", "uz"), BUTEE_OK) << butee_message();
  int64_t dofs[5];
  for (int i = 0; i < 5; ++i) {
    ASSERT_EQ(butee_dof(body, "m", kinds[i].second, &dofs[i]), BUTEE_OK) << butee_message();
    ASSERT_EQ(butee_set_force(body, dofs[i], 3.0), BUTEE_OK) << butee_message();
  }
  ASSERT_EQ(butee_advance_to(body, 0.7), BUTEE_OK) << butee_message();
  stiffness = 100.0;
  for (int i = 0; i < 5; ++i) {
    stiffness *= 2.0;
    const double inertia = i < 3 ? 2.0 : 0.5,
                 wanted = 3.0 / stiffness * (1.0 - std::cos(std::sqrt(stiffness / inertia) * 0.7));
    double u = 0.0;
    ASSERT_EQ(butee_motion(body, dofs[i], &u, nullptr, nullptr), BUTEE_OK);
    EXPECT_NEAR(u, wanted, 1e-13) << kinds[i].first;
  }
  double peak = 0.0;
  ASSERT_EQ(butee_peak(body, "m", "uz", &peak), BUTEE_OK) << butee_message();
  EXPECT_NEAR(peak, 2.0 * 3.0 / 800.0, 1e-12);
  int64_t none = 0;
  EXPECT_EQ(butee_dof(body, "m", BUTEE_RX, &none), BUTEE_BAD_INPUT);
  EXPECT_NE(std::strstr(butee_message(), "rx does not exist there"), nullptr) << butee_message();
  butee_close(body);
}

TEST_F(CInterface, TurnsEveryMistakeIntoAStatusAndAMessage) {
  butee_structure* none = reinterpret_cast<butee_structure*>(this);
  EXPECT_EQ(butee_open_text("schema = 2", nullptr, &none), BUTEE_BAD_INPUT);
  EXPECT_EQ(none, nullptr);
  EXPECT_NE(std::strstr(butee_message(), "schema"), nullptr) << butee_message();
  EXPECT_EQ(butee_open_file("nowhere.toml", nullptr, &none), BUTEE_BAD_INPUT);
  EXPECT_EQ(butee_open_file(nullptr, nullptr, &none), BUTEE_BAD_CALL);
  int64_t dof = 7;
  EXPECT_EQ(butee_dof(mass_, "nobody", BUTEE_U, &dof), BUTEE_BAD_INPUT);
  EXPECT_EQ(butee_dof(mass_, "m", 6, &dof), BUTEE_BAD_CALL);
  EXPECT_EQ(butee_dof(nullptr, "m", BUTEE_U, &dof), BUTEE_BAD_CALL);
  EXPECT_EQ(dof, 7);
  double number = 0.0;
  EXPECT_EQ(butee_motion(mass_, 1, &number, &number, &number), BUTEE_BAD_CALL);
  EXPECT_EQ(butee_all_motion(mass_, 2, &number, &number, &number), BUTEE_BAD_CALL);
  EXPECT_EQ(butee_advance_to(mass_, -1.0), BUTEE_BAD_CALL);
  EXPECT_EQ(butee_set_force(mass_, -3, 1.0), BUTEE_BAD_CALL);
  butee_close(nullptr);
  butee_free_snapshot(nullptr);
}

}  // namespace
}  // namespace butee::test::c_interface_test
