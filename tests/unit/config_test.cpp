#include <algorithm>
#include <cmath>
#include <limits>
#include <locale>

#include <butee/config/override.hpp>
#include <butee/config/parameters.hpp>
#include <butee/config/toml.hpp>
#include <butee/core/error.hpp>
#include <butee/core/text.hpp>
#include <gtest/gtest.h>

#include "unit/scenes.hpp"

namespace butee::test::config_test {
namespace {

using config::Array;
using config::Document;
using config::Parameter;
using config::parse_toml;
using config::Table;
using config::Value;

/// True if two values are equal, including the order of tables; source positions are ignored.
bool same(const Value& a, const Value& b) {
  if (a.data.index() != b.data.index()) return false;
  if (const Table* table = a.table()) {
    const auto &p = table->entries, &q = b.table()->entries;
    return std::equal(p.begin(), p.end(), q.begin(), q.end(),
                      [](const auto& x, const auto& y) { return x.first == y.first && same(x.second, y.second); });
  }
  if (const Array* array = a.array()) {
    const Array& other = *b.array();
    return std::equal(array->begin(), array->end(), other.begin(), other.end(), same);
  }
  if (const auto* x = std::get_if<double>(&a.data)) {
    const double y = std::get<double>(b.data);
    return *x == y || (std::isnan(*x) && std::isnan(y));
  }
  if (const auto* x = std::get_if<bool>(&a.data)) return *x == std::get<bool>(b.data);
  if (const auto* x = std::get_if<std::int64_t>(&a.data)) return *x == std::get<std::int64_t>(b.data);
  return *a.text() == *b.text();
}

constexpr const char* kText = R"(schema = 1
title = "a \"quoted\" one \\ with a tab \t and é"
flag = false
numbers = [1, -2.5, 1.0e-300, 0.1, 1e22, inf]
nested = [[1, 2], ["x"], []]
inline = { a = 1, "odd key" = { b = true } }

[integrator]
type = "newmark"
time_step = 1e-5

[integrator.newmark]
max_iterations = 10

[[contact]]
gap = 0.01

[[contact]]
gap = 2

[[output.probe]]
label = "mid"
)";

TEST(Toml, WrittenAndReadAgainIsTheSame) {
  const Document first = parse_toml(kText, "first");
  const std::string text = write_toml(*first.root.table());
  const Document second = parse_toml(text, "second");
  EXPECT_EQ(write_toml(*second.root.table()), text);
  for (const auto& [key, value] : first.root.table()->entries) {
    const Value* other = second.root.table()->find(key);
    ASSERT_NE(other, nullptr) << key;
    EXPECT_TRUE(same(value, *other)) << key << " in\n" << text;
  }
  EXPECT_EQ(first.root.table()->entries.size(), second.root.table()->entries.size());
}

TEST(Toml, ScenesOfTheRepositorySurviveARoundTrip) {
  for (const char* stem : {"oscillator", "beam1", "beam4"}) {
    const Document scene = config::load_toml(model_path(stem));
    const Document again = parse_toml(write_toml(*scene.root.table()), stem);
    for (const auto& [key, value] : scene.root.table()->entries)
      EXPECT_TRUE(same(value, *again.root.table()->find(key))) << stem << " " << key;
  }
}

TEST(Toml, NumbersKeepEveryBitAndTheirKind) {
  for (const double x : {0.1, 1.0, -0.0, 1e300, 5e-324, 2.0 / 3.0, 7.0e7, 1.7e308}) {
    const auto value = config::parse_toml_value(to_text(x));
    ASSERT_TRUE(value.has_value()) << to_text(x);
    ASSERT_TRUE(std::holds_alternative<double>(value->data)) << to_text(x);
    EXPECT_EQ(std::signbit(std::get<double>(value->data)), std::signbit(x));
    EXPECT_EQ(std::get<double>(value->data), x);
  }
  EXPECT_TRUE(std::holds_alternative<std::int64_t>(config::parse_toml_value("7")->data));
}

TEST(Toml, ValuesKnowTheirLines) {
  const Document document = parse_toml(kText, "scene.toml");
  const Value& contact = (*document.root.table()->find("contact")->array())[1];
  EXPECT_EQ(describe(document, contact.table()->find("gap")->at), "scene.toml:19");

  std::string text = "numbers = [\n";
  for (int line = 2; line < 1000; ++line) text += std::to_string(line) + ",\n";
  const Document lines = parse_toml(text + "]\n", "long.toml");
  for (const Value& number : *lines.root.table()->find("numbers")->array())
    ASSERT_EQ(number.at.line, std::get<std::int64_t>(number.data));
}

TEST(Toml, MistakesNameFileAndLine) {
  for (const char* text : {"a = 1\nb = \n", "a = 1\nb = [1,\n", "a = 1\na = 2\n", "a = 1\n[b\n"}) {
    try {
      parse_toml(text, "scene.toml");
      FAIL() << "no complaint about " << text;
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).rfind("scene.toml:", 0), 0U) << error.what();
      EXPECT_TRUE(holds(error.what(), "not valid TOML")) << error.what();
    }
  }
  EXPECT_THROW(parse_toml("day = 1979-05-27\n", "scene.toml"), InputError);
  EXPECT_THROW(config::load_toml("/no/such/file.toml"), InputError);
}

class Override : public testing::Test {
 protected:
  const Value& at(const std::string& key) { return *document_.root.table()->find(key); }
  Document document_ = parse_toml(kText, "scene.toml");
};

TEST_F(Override, ChangesAKeyOfATable) {
  apply_override(document_, "integrator.time_step=1e-6");
  EXPECT_EQ(std::get<double>(at("integrator").table()->find("time_step")->data), 1e-6);
  EXPECT_EQ(describe(document_, at("integrator").table()->find("time_step")->at), "--set integrator.time_step=1e-6");
}

TEST_F(Override, ChangesAnEntryOfAnArrayOfTables) {
  apply_override(document_, "contact[0].gap=0.5");
  apply_override(document_, "numbers[1]=9");
  EXPECT_EQ(std::get<double>((*at("contact").array())[0].table()->find("gap")->data), 0.5);
  EXPECT_EQ(std::get<std::int64_t>((*at("contact").array())[1].table()->find("gap")->data), 2);
  EXPECT_EQ(std::get<std::int64_t>((*at("numbers").array())[1].data), 9);
}

TEST_F(Override, TakesWhatIsNotTomlAsAString) {
  apply_override(document_, "integrator.type=NM2");
  apply_override(document_, "title=a=b");
  apply_override(document_, "flag=true");
  EXPECT_EQ(*at("integrator").table()->find("type")->text(), "NM2");
  EXPECT_EQ(*at("title").text(), "a=b");
  EXPECT_EQ(std::get<bool>(at("flag").data), true);
}

TEST_F(Override, MakesTablesOnTheWay) {
  apply_override(document_, "damping.mass_proportional=0.5");
  EXPECT_EQ(std::get<double>(at("damping").table()->find("mass_proportional")->data), 0.5);
}

TEST_F(Override, TakesOutAKeyWithoutAValue) {
  apply_override(document_, "integrator.type=");
  EXPECT_EQ(at("integrator").table()->find("type"), nullptr);
  EXPECT_THROW(apply_override(document_, "integrator.type="), InputError);
  EXPECT_THROW(apply_override(document_, "contact[0]="), InputError);
}

TEST_F(Override, RefusesWhatItCannotFollow) {
  for (const char* wrong : {"contact[2].gap=1", "contact[x].gap=1", "contact[0.gap=1", "contact[0]gap=1", "title.x=1",
                            "title[0]=1", "no_equals", "=1", ".a=1", "a..b=1"})
    EXPECT_THROW(apply_override(document_, wrong), InputError) << wrong;
}

TEST(Parameter, ComplainsAboutKindBoundsAndChoices) {
  using std::string;
  const Parameter gap = config::number("gap", "m", "free play").at_least(0);
  EXPECT_EQ(gap.complaint(Value(0.0)), "");
  EXPECT_EQ(gap.complaint(Value(std::int64_t{3})), "");
  EXPECT_EQ(gap.complaint(Value(-1.0)), "must be >= 0 (m)");
  EXPECT_EQ(gap.complaint(Value(string("x"))), "must be a number, not a string");
  EXPECT_EQ(gap.complaint(Value(std::numeric_limits<double>::infinity())), "must be a finite number (m)");
  EXPECT_EQ(gap.complaint(Value(std::nan(""))), "must be a finite number (m)");
  EXPECT_EQ(gap.above(0).complaint(Value(0.0)), "must be > 0 (m)");
  EXPECT_EQ(gap.at_most(2).complaint(Value(3.0)), "must be >= 0 and <= 2 (m)");

  const Parameter count = config::integer("count", "how many").at_least(1);
  EXPECT_EQ(count.complaint(Value(1.0)), "must be an integer, not a number; write it as 1");
  EXPECT_EQ(count.complaint(Value(1.5)), "must be an integer, not a number");
  EXPECT_EQ(count.at_most(5).complaint(Value(1e9)), "must be >= 1 and <= 5");
  EXPECT_EQ(count.complaint(Value(std::int64_t{0})), "must be >= 1");

  const Parameter side = config::text("sides", "the sides").one_of({"both", "positive", "negative"});
  EXPECT_EQ(side.complaint(Value(string("both"))), "");
  EXPECT_EQ(side.complaint(Value(string("positiv"))),
            "must be one of \"both\", \"positive\", \"negative\" (did you mean \"positive\"?)");

  const Parameter band = config::numbers("band", "1", "two numbers").of_length(2).above(0);
  EXPECT_EQ(band.complaint(Value(Array{Value(1.0), Value(2.0)})), "");
  EXPECT_EQ(band.complaint(Value(Array{Value(1.0)})), "must hold 2 values, not 1");
  EXPECT_EQ(band.complaint(Value(Array{Value(1.0), Value(-2.0)})), "entry 1 (counted from 0): must be > 0");
  EXPECT_EQ(config::boolean("on", "").complaint(Value(std::int64_t{1})), "must be true or false, not an integer");
  EXPECT_EQ(config::texts("nodes", "").complaint(Value(string("a"))), "");
  EXPECT_EQ(config::table("probe", "").complaint(Value(1.0)), "must be a table, not a number");
}

TEST(Parameter, AllMistakesOfATableComeInOneGo) {
  const Document document = parse_toml("gap = -1\nstifness = 3.0\n", "scene.toml");
  config::Diagnostics diagnostics(document);
  const std::vector<Parameter> declared = {config::number("gap", "m", "free play").at_least(0),
                                           config::number("stiffness", "N/m", "the stiffness").above(0)};
  EXPECT_FALSE(read_parameters(document.root, "contact[0]", declared, diagnostics).has_value());
  ASSERT_EQ(diagnostics.error_count(), 2U);
  try {
    diagnostics.throw_if_any();
    FAIL() << "no complaint";
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_TRUE(holds(message, "scene.toml:1: contact[0].gap = -1: must be >= 0 (m)")) << message;
    EXPECT_TRUE(holds(message, "scene.toml:2: contact[0].stifness = 3.0: unknown key (did you mean \"stiffness\"?)"));
    EXPECT_FALSE(holds(message, "missing")) << "one mistake with two messages: " << message;
  }
}

TEST(Parameter, DefaultsAreToldFromWhatWasGiven) {
  Table given;
  given["beta"] = Value(0.3);
  const auto p =
      config::make_parameters({config::number("beta", "1", "").or_else(0.25),
                               config::number("gamma", "1", "").or_else(0.5), config::text("node", "").optional()},
                              given);
  EXPECT_EQ(p.number("beta"), 0.3);
  EXPECT_TRUE(p.given("beta"));
  EXPECT_EQ(p.number("gamma"), 0.5);
  EXPECT_FALSE(p.given("gamma"));
  EXPECT_FALSE(p.has("node"));
  EXPECT_THROW((void)p.text("node"), LogicError);
  EXPECT_THROW(config::make_parameters({config::number("beta", "1", "")}), InputError);
}

TEST(Text, ClosestNameIsNearOrNothing) {
  const std::vector<std::string> known = {"newmark", "newmark_adaptive", "rk4", "stiffness"};
  EXPECT_EQ(closest_name("newmrak", known), "newmark");
  EXPECT_EQ(closest_name("stifness", known), "stiffness");
  EXPECT_EQ(closest_name("rk5", known), "rk4");
  EXPECT_EQ(closest_name("elephant", known), "");
  EXPECT_EQ(closest_name("", known), "");
  EXPECT_EQ(suggestion("newmark_adaptiv", known), " (did you mean \"newmark_adaptive\"?)");
  EXPECT_EQ(suggestion("zzz", known), "");
}

/// A host program may have set a locale whose numbers have decimal commas and groups of three.
TEST(Toml, ReadsNumbersTheSameInEveryLocale) {
  struct German final : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
  };
  const std::string text = "a = 1.5\nb = [7850.0, -2.5e-3]\nc = 1_000.25\nd = { e = +0.125 }\nf = 21_000\n";
  const Document plain = parse_toml(text, "x.toml");
  const std::locale before = std::locale::global(std::locale(std::locale(), new German));
  const Document german = parse_toml(text, "x.toml");
  std::locale::global(before);
  EXPECT_TRUE(same(german.root, plain.root));
  EXPECT_EQ(config::as_number(*german.root.table()->find("a")), 1.5);
  EXPECT_EQ(config::as_number(*german.root.table()->find("c")), 1000.25);
}

}  // namespace
}  // namespace butee::test::config_test
