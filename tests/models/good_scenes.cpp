#include "bad_scenes.hpp"

namespace butee::test {
namespace {

constexpr const char* kLoad =
    "type = \"harmonic\"\nnode = \"string:2\"\ndof = \"u\"\namplitude = 300.0\nangular_frequency = 6.0";
constexpr const char* kInitial = "displacement = [{ nodes = \"rotor\", dof = \"u\", value = 0.001 }]";
constexpr const char* kStopNodes = "nodes = \"rotor\"\ngap";
constexpr const char* kRayleigh = "mass_proportional = 0.03";
constexpr const char* kMethod = "type = \"newmark_modified\"";

}  // namespace

std::vector<GoodScene> good_scenes() {
  return {
      {"the scene itself", {}},
      {"integers for numbers",
       {{"young_modulus = 2.0e11", "young_modulus = 200000000000"},
        {"gap = 0.01", "gap = 1"},
        {"length = 4.0", "length = 4"},
        {"end_time = 1.0", "end_time = 1"}}},
      {"lines that end as on Windows", {{"schema = 1\n", "schema = 1\r\n"}, {"[damping]\n", "[damping]\r\n"}}},
      {"no title, damping, initial values or output",
       {{"title = \"Scene\"\n", ""},
        {"[damping]\nmass_proportional = 0.03\n", ""},
        {std::string("[initial]\n") + kInitial, ""},
        {"[output]\ninterval = 1.0e-3\n\n[[output.probe]]\nlabel = \"mid\"\nnode = \"string:middle\"\nquantities = "
         "[\"u\", "
         "\"v\"]\n",
         ""}}},
      {"one damping ratio for every mode", {{kRayleigh, "modal = 0.02"}}},
      {"damping ratios of all modes, one by one", {{kRayleigh, "modal = [0.02, 0.01, 0, 0, 0, 1, 0.5, 0, 2]"}}},
      {"no modal damping at all", {{kRayleigh, "modal = 0"}}},
      {"damping ratios of the lowest modes of a large system",
       {{"elements = 4", "elements = 600"}, {kRayleigh, "modal = [0.02]"}}},
      {"no contact and no load",
       {{"[[load]]\n" + std::string(kLoad), ""},
        {"[[contact]]\ntype = \"stop\"\nnodes = \"rotor\"\ngap = 0.01\nsides = \"both\"\nlaw = \"arctan\"\nstiffness = "
         "1.0e6\n"
         "regularization = 7.0e7",
         ""}}},
      {"default law and sides",
       {{"sides = \"both\"\nlaw = \"arctan\"\nstiffness = 1.0e6\nregularization = 7.0e7", "stiffness = 1.0e6"}}},
      {"no gap at all", {{"gap = 0.01", "gap = 0"}}},
      {"stops on fixed nodes", {{kStopNodes, "nodes = \"string:all\"\ngap"}}},
      {"list of selectors", {{kStopNodes, "nodes = [\"string:1..2\", \"string@3\", \"rotor\"]\ngap"}}},
      {"stops between two bodies", {{kStopNodes, "between = [\"string:middle\", \"rotor\"]\ngap"}}},
      {"load table of one instant", {{kLoad, "type = \"table\"\nnode = \"string:2\"\ntimes = [0]\nvalues = [-1]"}}},
      {"moment on a supported end", {{"node = \"string:2\"\ndof = \"u\"", "node = \"string:last\"\ndof = \"theta\""}}},
      {"distributed load", {{kLoad, "type = \"distributed\"\nbeam = \"string\"\nvalue = -2"}}},
      {"distributed load in time",
       {{kLoad,
         "type = \"distributed\"\nbeam = \"string\"\nvalue = 2\n[load.in_time]\ntype = \"ramp\"\nto = 1\nend = 1"}}},
      {"negative amplitude and phase", {{"amplitude = 300.0", "amplitude = -300.0\nphase = -1"}}},
      {"empty list of velocities", {{kInitial, "displacement = []\nvelocity = []"}}},
      {"one initial value without a list", {{kInitial, "velocity = { nodes = \"string:1..3\", value = 1 }"}}},
      {"uneven mesh that starts anywhere",
       {{"length = 4.0\nelements = 4", "coordinates = [-2, -1.5, 0, 1, 4.0]"},
        {"node = \"string:middle\"", "node = \"string@-1.5\""}}},
      {"beams that share a node",
       {{"[[element]]\ntype = \"mass\"",
         "[[element]]\ntype = \"beam\"\nname = \"more\"\nmaterial = \"steel\"\nsection = \"pipe\"\nlength = "
         "1\nelements = 1\n"
         "start_node = \"string:last\"\n\n[[element]]\ntype = \"mass\""}}},
      {"mass with a rotary inertia on a turning spring",
       {{"mass = 100.0", "mass = 100.0\nrotary_inertia = 1"},
        {"[[element]]\ntype = \"spring\"", "[[element]]\ntype = \"spring\"\ndof = \"theta\""}}},
      {"masses and springs without a name",
       {{"name = \"bearing\"\n", ""},
        {"[[support]]", "[[element]]\ntype = \"mass\"\nnode = \"string:1\"\nmass = 1\n\n[[support]]"}}},
      {"support of one node and one displacement",
       {{"nodes = [\"string:first\", \"string:last\"]\nfix = [\"u\"]", "nodes = \"string:all\"\nfix = \"theta\""}}},
      {"an alias", {{kMethod, "type = \"RK4-1\""}}},
      {"tables of several methods, one of the chosen by its alias",
       {{kMethod, "type = \"NM2\"\nresidual_tolerance = 1e-9"},
        {"[output]",
         "[integrator.NM2]\nresidual_tolerance = 1\nincrement_tolerance = 1e-9\nmax_iterations = 10\ntarget_error = "
         "1e-2\nband "
         "= [1, 1]\n[integrator.rk4_error_scaled]\nsafety = 0.9\n\n[output]"}}},
      {"one step", {{"time_step = 1.0e-5", "time_step = 1.0"}}},
      {"interval beyond the end", {{"interval = 1.0e-3", "interval = 2"}}},
      {"a billion rows", {{"interval = 1.0e-3", "interval = 1.0e-9"}}},
      {"every step", {{"interval = 1.0e-3", "every = 1\nenergy = true\nimpacts = true\nformats = \"csv\""}}},
      {"probe of one quantity on a fixed node",
       {{"node = \"string:middle\"", "node = \"string:first\""},
        {"quantities = [\"u\", \"v\"]", "quantities = \"contact_force\""}}},
      {"a probe named after its node", {{"label = \"mid\"", ""}}},
      {"overrides of all kinds",
       {},
       {"integrator.type=NMM1", "contact[0].gap=0", "output.probe[0].label=\"a-b_1\"", "initial.velocity=[]",
        "load[0].phase=1", "support[0].nodes=[\"string:first\"]", "title=not TOML"}},
  };
}

}  // namespace butee::test
