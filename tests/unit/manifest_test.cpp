#include <cmath>

#include <butee/core/error.hpp>
#include <butee/plugin/manifest.hpp>
#include <gtest/gtest.h>

#include "integrators/methods.hpp"
#include "support/program.hpp"

namespace butee::test::manifest_test {
namespace {

using config::Parameter;

void expect_same(const Parameter& got, const Parameter& wanted) {
  EXPECT_EQ(got.name, wanted.name);
  EXPECT_EQ(got.kind, wanted.kind);
  EXPECT_EQ(got.unit, wanted.unit);
  EXPECT_EQ(got.help, wanted.help);
  EXPECT_EQ(got.required, wanted.required);
  EXPECT_EQ(got.fallback.has_value(), wanted.fallback.has_value());
  if (got.fallback && wanted.fallback) {
    EXPECT_EQ(config::as_number(*got.fallback), config::as_number(*wanted.fallback));
    EXPECT_STREQ(got.fallback->kind(), wanted.fallback->kind());
  }
  EXPECT_EQ(got.lower, wanted.lower);
  EXPECT_EQ(got.upper, wanted.upper);
  EXPECT_EQ(got.lower_open, wanted.lower_open);
  EXPECT_EQ(got.choices, wanted.choices);
  EXPECT_EQ(got.swept, wanted.swept);
  EXPECT_EQ(got.first_try.has_value(), wanted.first_try.has_value());
  EXPECT_EQ(got.length, wanted.length);
}

void expect_same(const time::IntegratorType& got, const time::IntegratorType& wanted) {
  EXPECT_EQ(got.name, wanted.name);
  EXPECT_EQ(got.aliases, wanted.aliases);
  EXPECT_EQ(got.summary, wanted.summary);
  EXPECT_EQ(got.order, wanted.order);
  EXPECT_EQ(got.stability_limit, wanted.stability_limit);
  EXPECT_EQ(got.damping_limit, wanted.damping_limit);
  EXPECT_EQ(got.fixed_step, wanted.fixed_step);
  EXPECT_EQ(got.finds_first_step, wanted.finds_first_step);
  ASSERT_EQ(got.parameters.size(), wanted.parameters.size());
  for (std::size_t i = 0; i < got.parameters.size(); ++i) expect_same(got.parameters[i], wanted.parameters[i]);
}

TEST(Manifest, WrittenAndReadAgainIsTheSame) {
  const TemporaryFolder folder;
  const std::vector<time::IntegratorType> types = {integrators::rk4_type(),
                                                   integrators::rk4_fixed_factors_type(),
                                                   integrators::rk4_error_scaled_type(),
                                                   integrators::newmark_type(),
                                                   integrators::newmark_adaptive_type(),
                                                   integrators::newmark_modified_type(),
                                                   integrators::newmark_modified_adaptive_type()};
  folder.write("all.toml", plugin::write_manifest({types, {}, {}, {}}));
  const plugin::ModuleTypes manifest = plugin::read_manifest(folder.file("all.toml"));
  ASSERT_EQ(manifest.integrators.size(), types.size());
  for (std::size_t i = 0; i < types.size(); ++i) {
    SCOPED_TRACE(types[i].name);
    expect_same(manifest.integrators[i], types[i]);
    EXPECT_FALSE(manifest.integrators[i].make);
  }
}

TEST(Manifest, KeepsEveryKindOfParameter) {
  const TemporaryFolder folder;
  time::IntegratorType type;
  type.name = "mine";
  type.summary = "quotes \" and \\ survive";
  type.parameters = {
      config::number("a", "m", "a length").above(-1.5).at_most(2).or_else(0.1),
      config::integer("b", "a count").at_least(1),
      config::boolean("c", "a switch").or_else(true),
      config::text("d", "a choice").one_of({"x", "y z"}).or_else(std::string("x")),
      config::numbers("e", "s", "three times").of_length(3).optional(),
      config::texts("f", "some names").optional(),
      config::table("g", "a table").optional(),
  };
  folder.write("mine.toml", plugin::write_manifest({{type}, {}, {}, {}}));
  const plugin::ModuleTypes manifest = plugin::read_manifest(folder.file("mine.toml"));
  ASSERT_EQ(manifest.integrators.size(), 1U);
  expect_same(manifest.integrators[0], type);
  EXPECT_EQ(std::get<bool>(manifest.integrators[0].parameters[2].fallback->data), true);
  EXPECT_EQ(*manifest.integrators[0].parameters[3].fallback->text(), "x");
}

TEST(Manifest, StandsBesideItsModule) {
  EXPECT_EQ(plugin::manifest_path("/some/where/method.so"), "/some/where/method.toml");
}

TEST(Manifest, WhatIsNoneIsRefused) {
  const TemporaryFolder folder;
  for (const char* text : {"", "manifest = 1\n[[law]]\nname = \"a\"\nsummary = \"\"\nparameter = []\n",
                           "manifest = 6\n", "manifest = 6\nintegrator = []\n", "manifest = 6\nintegrator = [3]\n",
                           "manifest = 6\n[[integrator]]\nname = \"a\"\naliases = [1]\n", "not toml"}) {
    folder.write("wrong.toml", text);
    EXPECT_THROW(plugin::read_manifest(folder.file("wrong.toml")), InputError) << text;
  }
  EXPECT_THROW(plugin::read_manifest(folder.file("absent.toml")), InputError);
}

}  // namespace
}  // namespace butee::test::manifest_test
