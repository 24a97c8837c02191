#include "bad_scenes.hpp"

namespace butee::test {

std::vector<BadScene> bad_contact_scenes() {
  const std::string nodes = "nodes = \"rotor\"\ngap";
  const auto between = [&](const std::string& selectors) { return Edit{nodes, "between = " + selectors + " #!\ngap"}; };
  return {
      {"negative gap", {{"gap = 0.01", "gap = -0.01 #!"}}, {"contact[0].gap = -0.01: must be >= 0 (m)"}},
      {"gap missing",
       {{"[[contact]]", "[[contact]] #!"}, {"gap = 0.01\n", ""}},
       {"contact[0].gap: missing; give the free play on each side (number >= 0, m)"}},
      {"no stiffness in a stop",
       {{"stiffness = 1.0e6", "stiffness = 0 #!"}},
       {"contact[0].stiffness = 0: must be > 0 (N/m)"}},
      {"infinite stiffness",
       {{"stiffness = 1.0e6", "stiffness = +inf #!"}},
       {"contact[0].stiffness = inf: must be a finite number (N/m)"}},
      {"unknown side",
       {{"sides = \"both\"", "sides = \"bth\" #!"}},
       {"contact[0].sides = \"bth\": must be one of \"both\", \"positive\", \"negative\" (did you mean \"both\"?)"}},
      {"unknown law",
       {{"law = \"arctan\"", "law = \"arctn\" #!"}},
       {"contact[0].law = \"arctn\": must be one of ", "\"arctan\"", "\"linear\"", "(did you mean \"arctan\"?)"}},
      {"unknown law beside a negative gap",
       {{"gap = 0.01", "gap = -0.01 #!"}, {"law = \"arctan\"", "law = \"arctn\" #!"}},
       {"contact[0].gap = -0.01: must be >= 0 (m)", "contact[0].law = \"arctn\": must be one of"}},
      {"regularization of the linear law",
       {{"law = \"arctan\"", "law = \"linear\""}, {"regularization = 7.0e7", "regularization = 7.0e7 #!"}},
       {"contact[0].regularization = 7e+07: unknown key", "known here: ", "stiffness"}},
      {"regularization missing",
       {{"[[contact]]", "[[contact]] #!"}, {"regularization = 7.0e7\n", ""}},
       {"contact[0].regularization: missing; give lambda"}},
      {"every key wrong or missing",
       {{"[[contact]]\n", "[[contact]] #!!\nnodes = 3 #!\nlaw = 2 #!\n\n[[contact]]\n"}},
       {"contact[0].type: missing; give one of \"stop\"", "contact[0].gap: missing",
        "contact[0].nodes = 3: must be a string or an array of strings, not an integer",
        "contact[0].law = 2: must be one of"}},
      {"contact of another type",
       {{"type = \"stop\"", "type = \"bumper\" #!"}},
       {"contact[0].type = \"bumper\": must be one of \"stop\""}},
      {"contact written as a table",
       {{"[[contact]]", "[contact] #!"}},
       {"contact = { type = \"stop\"", "must be an array of tables: write [[contact]]"}},
      {"contact that is no table",
       {{"[[contact]]\ntype = \"stop\"\nnodes = \"rotor\"\ngap = 0.01\nsides = \"both\"\nlaw = \"arctan\"\nstiffness = "
         "1.0e6\n"
         "regularization = 7.0e7",
         ""},
        {"schema = 1", "schema = 1\ncontact = [3] #!"}},
       {"contact[0] = 3: must be a table, not an integer"}},
      {"unknown key of a contact",
       {{"gap = 0.01", "gap = 0.01\nside = \"both\" #!"}},
       {"contact[0].side = \"both\": unknown key (did you mean \"sides\"?)"}},
      {"neither nodes nor between",
       {{"[[contact]]", "[[contact]] #!"}, {nodes, "gap"}},
       {"contact[0]: give nodes (stops to ground) or between (stops between two bodies)"}},
      {"nodes and between",
       {{"[[contact]]", "[[contact]] #!"}, {nodes, "nodes = \"rotor\"\nbetween = [\"rotor\", \"string:1\"]\ngap"}},
       {"contact[0]: has both nodes and between; give one of them"}},
      {"between unequal numbers",
       {between("[\"string:1..3\", \"rotor\"]")},
       {"contact[0].between = [\"string:1..3\", \"rotor\"]: pairs nodes one by one, but the first selector names 3 and "
        "the "
        "second 1"}},
      {"between one selector",
       {between("[\"rotor\"]")},
       {"contact[0].between = [\"rotor\"]: must hold two selectors, such as [\"rotor:3..9\", \"casing:3..9\"]"}},
      {"between a text", {between("\"rotor\"")}, {"contact[0].between = \"rotor\": must hold two selectors"}},
      {"between a node and itself",
       {between("[\"string:2\", \"string:middle\"]")},
       {"string:2 and string:2 are one node, which has no motion against itself"}},
      {"between dangling names",
       {{nodes, "between = [\"roter\", \"casing:3\"] #!!\ngap"}},
       {"\"roter\": there is no node or beam \"roter\" (did you mean \"rotor\"?)",
        "\"casing:3\": there is no node or beam \"casing\""}},
  };
}

}  // namespace butee::test
