#include <functional>

#include <butee/config/toml.hpp>
#include <butee/core/error.hpp>
#include <gtest/gtest.h>

namespace butee::test::table_order_test {
namespace {

using config::Document;
using config::parse_toml;
using config::Table;
using config::Value;

/// The same document with tables after their parts, which is also valid TOML: the values are equal, and line
/// numbers are those of the given text.
TEST(TableOrder, ATableMayComeAfterItsParts) {
  struct Pair {
    const char *given, *usual, *key;
    int line;
  };
  const std::vector<Pair> pairs = {
      {"[[o.probe]]\na = 1\n[[o.probe]]\na = 2\n[o]\nb = 3", "[o]\nb = 3\n[[o.probe]]\na = 1\n[[o.probe]]\na = 2\n",
       "b", 6},
      {"x = 1\n[i.NM2]\na = 1 # [i]\n\n[other]\nc = 2\n[i]\nb = 3\n",
       "x = 1\n[i]\nb = 3\n[i.NM2]\na = 1\n[other]\nc = 2\n", "b", 8},
      {"[a.b.c]\nd = 1\n[a]\ne = 2\n[a.b]\nf = 3\n", "[a]\ne = 2\n[a.b]\nf = 3\n[a.b.c]\nd = 1\n", "e", 4},
      {"[a.b.c]\nd = 1\n[a.b]\nf = 3\n[a]\ne = 2\n", "[a]\ne = 2\n[a.b]\nf = 3\n[a.b.c]\nd = 1\n", "e", 6},
      // Parts of list elements belong to the preceding element.
      {"[[l]]\n[l.a.b]\nx = 1\n[l.a]\ny = 2\n[[l]]\n[l.a.b]\nx = 3\n[l.a]\nz = 4\n",
       "[[l]]\n[l.a]\ny = 2\n[l.a.b]\nx = 1\n[[l]]\n[l.a]\nz = 4\n[l.a.b]\nx = 3\n", "z", 10},
      // Headers within strings and arrays are not headers; keys may be quoted.
      {"[\"o p\".q]\nt = \"\"\"\n[\"o p\"]\n\"\"\"\nu = [\n[1],\n[2]]\n[ 'o p' ]\nb = 3\n",
       "[\"o p\"]\nb = 3\n[\"o p\".q]\nt = \"\"\"\n[\"o p\"]\n\"\"\"\nu = [[1],[2]]\n", "b", 9},
  };
  for (const Pair& pair : pairs) {
    const Document given = parse_toml(pair.given, "given"), usual = parse_toml(pair.usual, "usual");
    const auto text = [](const Document& document) { return config::write_toml(*document.root.table()); };
    EXPECT_EQ(text(given), text(usual)) << pair.given;
    const std::function<const Value*(const Table&)> find = [&](const Table& table) -> const Value* {
      for (const auto& [key, value] : table.entries) {
        if (key == pair.key) return &value;
        if (value.table() != nullptr)
          if (const Value* found = find(*value.table())) return found;
        if (value.array() != nullptr)
          for (const Value& item : *value.array())
            if (item.table() != nullptr)
              if (const Value* found = find(*item.table())) return found;
      }
      return nullptr;
    };
    const Value* value = find(*given.root.table());
    ASSERT_NE(value, nullptr) << pair.given;
    EXPECT_EQ(value->at.line, pair.line) << pair.given;
  }
}

TEST(TableOrder, MistakesAreToldWithTheLineOfTheFile) {
  const auto complaint = [](const std::string& text) {
    try {
      parse_toml(text, "scene.toml");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const std::string parts_first = "[[o.probe]]\na = 1\n[x]\n[o]\nb = 3\n";
  EXPECT_EQ(complaint(parts_first), "");
  EXPECT_EQ(complaint(parts_first + "c = \n").substr(0, 13), "scene.toml:6:");
  EXPECT_EQ(complaint(parts_first + "c = 1979-05-27\n").substr(0, 13), "scene.toml:6:");
  EXPECT_EQ(complaint("[[o.probe]]\na = 1\na = 2\n[o]\nb = 3\n").substr(0, 13), "scene.toml:3:");
  EXPECT_NE(complaint(parts_first + "[o]\n").find("not valid TOML"), std::string::npos);
}

}  // namespace
}  // namespace butee::test::table_order_test
