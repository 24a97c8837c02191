#include "bad_scenes.hpp"

namespace butee::test {

std::vector<BadScene> bad_selector_scenes() {
  const auto load_on = [](const std::string& name, const std::string& selector, std::vector<std::string> says) {
    says.push_back("load[0].node = \"" + selector + "\": ");
    return BadScene{name, {{"node = \"string:2\"", "node = \"" + selector + "\" #!"}}, std::move(says)};
  };
  const std::string forms =
      "write string:first, string:last, string:middle, string:0 ... string:4, string:0..4, string:all or "
      "string@COORDINATE";
  return {
      load_on("dangling selector", "strng:2",
              {"there is no node or beam \"strng\" (did you mean \"string\"?); known: string, rotor"}),
      load_on("dangling and unlike every name", "casing",
              {"there is no node or beam \"casing\"; known: string, rotor"}),
      load_on("beam alone", "string", {"string is a beam of 5 nodes; " + forms}),
      load_on("many nodes where one is wanted", "string:1..3", {"names 3 nodes; exactly one is required"}),
      load_on("index out of range", "string:5", {"string has the nodes 0 ... 4"}),
      load_on("negative index", "string:-1", {"string has the nodes 0 ... 4"}),
      load_on("range beyond the end", "string:3..9", {"string has the nodes 0 ... 4"}),
      load_on("reversed range", "string:3..1", {"the range runs backwards", "write string:1..3"}),
      load_on("half a range", "string:3..", {"\"3..\" is not a part of a beam; " + forms}),
      load_on("unknown part", "string:frist",
              {"\"frist\" is not a part of a beam (did you mean \"first\"?); " + forms}),
      load_on("part of a lone node", "rotor:first", {"rotor is a single node; write \"rotor\" alone"}),
      load_on("coordinate between two nodes", "string@1.4",
              {"no node there; the nearest are string:1 at 1 m and string:2 at 2 m"}),
      load_on("coordinate beyond the end", "string@7", {"the nearest are string:3 at 3 m and string:4 at 4 m"}),
      load_on("coordinate that is no number", "string@here", {"string@here is not a coordinate in m"}),
      load_on("coordinate NaN", "string@nan", {"string@nan is not a coordinate in m"}),
      load_on("empty selector", "", {"there is no node or beam \"\"; known: string, rotor"}),
      {"no middle among an even number",
       {{"elements = 4", "elements = 5"}, {"node = \"string:middle\"", "node = \"string:middle\" #!"}},
       {"output.probe[0].node = \"string:middle\": \"string:middle\": string has an even number of nodes (6) and so "
        "none "
        "in the middle; the two nearest are string:2 and string:3"}},
      {"node named twice in a list",
       {{"nodes = \"rotor\"\ngap", "nodes = [\"string:1..3\", \"string:middle\"] #!\ngap"}},
       {"contact[0].nodes = [\"string:1..3\", \"string:middle\"]: names string:2 twice"}},
      {"joined nodes in a list",
       {{"[[element]]\ntype = \"mass\"",
         "[[element]]\ntype = \"beam\"\nname = \"casing\"\nmaterial = \"steel\"\nsection = \"pipe\"\nlength = 1\n"
         "elements = 1\nstart_node = \"string:last\"\n\n[[element]]\ntype = \"mass\""},
        {"nodes = \"rotor\"\ngap", "nodes = [\"string:last\", \"casing:first\"] #!\ngap"}},
       {"names one node twice: string:4 and casing:0 are joined"}},
      {"empty list", {{"nodes = \"rotor\"\ngap", "nodes = [] #!\ngap"}}, {"contact[0].nodes = []: names no node"}},
      {"two dangling in one list",
       {{"[\"string:first\", \"string:last\"]", "[\"strin:first\", \"string:lats\"] #!!"}},
       {"\"strin:first\": there is no node or beam \"strin\" (did you mean \"string\"?)",
        "\"string:lats\": \"lats\" is not a part of a beam (did you mean \"last\"?)"}},
      {"selector of a wrong kind",
       {{"node = \"string:2\"", "node = [\"string:2\"] #!"}},
       {"load[0].node = [\"string:2\"]: must be a string, not an array"}},
      {"selector and value wrong in one table",
       {{"nodes = \"rotor\"\ngap = 0.01", "nodes = \"motor\" #!\ngap = \"wide\" #!"}},
       {"contact[0].nodes = \"motor\": \"motor\": there is no node or beam \"motor\" (did you mean \"rotor\"?)",
        "contact[0].gap = \"wide\": must be a number, not a string"}},
      {"spring on a node that is not there",
       {{"node = \"rotor\"\nstiffness", "node = \"roter\" #!\nstiffness"}},
       {"element[2].node = \"roter\": \"roter\": there is no node or beam \"roter\" (did you mean \"rotor\"?)"}},
  };
}

}  // namespace butee::test
