#include <butee/config/toml.hpp>
#include <butee/core/error.hpp>
#include <gtest/gtest.h>

#include "unit/scenes.hpp"

namespace butee::test::number_arrays_test {
namespace {

using config::Array;
using config::parse_toml;
using config::Value;

/// The text of an array of `count` numbers, with `before` in front of each.
std::string array_of(int count, const std::string& number, const std::string& before = " ") {
  std::string text = "[";
  for (int i = 0; i < count; ++i) text += (i > 0 ? "," : "") + before + number;
  return text + "]";
}

const Array& array_in(const config::Document& document, const std::string& key) {
  return *document.root.table()->find(key)->array();
}

template <class Number>
void expect_each(const Array& array, std::size_t count, Number value) {
  ASSERT_EQ(array.size(), count);
  for (const Value& item : array) EXPECT_EQ(std::get<Number>(item.data), value);
}

TEST(NumberArrays, LongOnesHoldWhatShortOnesHold) {
  const std::vector<std::string> floats = {"0.1",  "-2.5e-3", "+1E+2", "12345678901234567890.0", "4.9e-324",
                                           "1e22", "-0.0",    "0e0",   "0.30000000000000004",    "1_000.5",
                                           "inf"};
  for (const std::string& number : floats) {
    const auto one = parse_toml("x = [" + number + "]", "short"),
               many = parse_toml("x = " + array_of(600, number), "long");
    expect_each(array_in(many, "x"), 600, std::get<double>(array_in(one, "x")[0].data));
  }
  for (const std::string number : {"0", "-17", "+3", "9223372036854775806", "0x1F", "1_000"}) {
    const auto one = parse_toml("x = [" + number + "]", "short"),
               many = parse_toml("x = " + array_of(600, number), "long");
    expect_each(array_in(many, "x"), 600, std::get<std::int64_t>(array_in(one, "x")[0].data));
  }
}

TEST(NumberArrays, StandAnywhereAndKeepTheLines) {
  const std::string lines = array_of(300, "1.5", "\n  # one more, \"quoted' ]\n\t");
  const auto document =
      parse_toml("a = 1\nx =" + lines + " # behind\nb = { y = " + lines + ", z = 2 }\nc = 3\n", "text");
  expect_each(array_in(document, "x"), 300, 1.5);
  EXPECT_EQ(array_in(document, "x")[0].at.line, 4);
  EXPECT_EQ(array_in(document, "x")[299].at.line, 602);
  const Value& b = *document.root.table()->find("b");
  ASSERT_EQ(b.table()->find("y")->array()->size(), 300U);
  EXPECT_EQ(b.table()->find("y")->array()->back().at.line, 1203);
  EXPECT_EQ(std::get<std::int64_t>(b.table()->find("z")->data), 2);
  EXPECT_EQ(document.root.table()->find("c")->at.line, 1204);
  std::string open = array_of(600, "1");
  open.insert(open.size() - 1, ",\n");
  expect_each(array_in(parse_toml("x = " + open, "text"), "x"), 600, std::int64_t{1});
}

TEST(NumberArrays, TextsCommentsAndHeadersAreLeftAlone) {
  const std::string numbers = array_of(600, "1");
  const auto document = parse_toml("# x = " + numbers + "\ns = \"x = " + numbers + "\"\nt = '''\nx = " + numbers +
                                       "\n'''\nu = 'it'\nn = [[1, 2], [3]]\n[[h]]\nx = 1\n",
                                   "text");
  EXPECT_EQ(*document.root.table()->find("s")->text(), "x = " + numbers);
  EXPECT_EQ(*document.root.table()->find("t")->text(), "x = " + numbers + "\n");
  EXPECT_EQ(array_in(document, "n").size(), 2U);
  EXPECT_EQ(array_in(document, "h").size(), 1U);
}

TEST(NumberArrays, WhatIsNotTomlStaysSo) {
  const auto message = [](const std::string& text) -> std::string {
    try {
      parse_toml(text, "text");
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  for (const std::string number : {"01.5", "1.", ".5", "1e", "--1", "1 2", "+", "1.5.2", "0x"})
    EXPECT_TRUE(holds(message("a = 1\nx = " + array_of(600, number)), "text:2: not valid TOML")) << number;
  EXPECT_TRUE(holds(message("x = " + array_of(600, "99999999999999999999")), "text:1")) << "beyond 64 bits";
  EXPECT_TRUE(holds(message("x = " + array_of(600, "1") + "]"), "text:1: not valid TOML"));
  EXPECT_TRUE(holds(message("x = " + array_of(600, "1") + " y = 2"), "text:1: not valid TOML"));
  std::string closed_late = array_of(600, "1");
  closed_late.pop_back();
  EXPECT_TRUE(holds(message("x = " + closed_late), "text:1: not valid TOML"));
}

TEST(NumberArrays, MayBeLongerThanAnyLine) {
  expect_each(array_in(parse_toml("x = " + array_of(40000, "0.25"), "text"), "x"), 40000, 0.25);
  EXPECT_THROW(parse_toml("x = " + array_of(40000, "\"a\""), "text"), InputError);
}

}  // namespace
}  // namespace butee::test::number_arrays_test
