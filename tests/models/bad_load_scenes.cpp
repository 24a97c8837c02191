#include "bad_scenes.hpp"

namespace butee::test {
namespace {

const std::string kLoad =
    "type = \"harmonic\"\nnode = \"string:2\"\ndof = \"u\"\namplitude = 300.0\nangular_frequency = 6.0";

Edit initial(const std::string& values) {
  return {"displacement = [{ nodes = \"rotor\", dof = \"u\", value = 0.001 }]", values};
}

}  // namespace

std::vector<BadScene> bad_load_scenes() {
  return {
      {"unknown load",
       {{"type = \"harmonic\"", "type = \"harmonics\" #!"}},
       {"load[0].type = \"harmonics\": must be one of \"harmonic\", \"constant\", \"ramp\", \"table\", \"unbalance\", "
        "\"distributed\" (did you mean \"harmonic\"?)"}},
      {"unknown load on a node that is not there",
       {{"type = \"harmonic\"\nnode = \"string:2\"", "type = \"harmonics\" #!\nnode = \"string:9\" #!"}},
       {"load[0].type = \"harmonics\": must be one of", "load[0].node = \"string:9\""}},
      {"key of another load",
       {{"amplitude = 300.0", "amplitude = 300.0\nvalue = 3 #!"}},
       {"load[0].value = 3: is no key of type = \"harmonic\"; it belongs to constant: remove it"}},
      {"amplitude missing",
       {{"[[load]]", "[[load]] #!"}, {"amplitude = 300.0\n", ""}},
       {"load[0].amplitude: missing; give the amplitude (N m on theta) (number, N)"}},
      {"node missing",
       {{"[[load]]", "[[load]] #!"}, {"node = \"string:2\"\n", ""}},
       {"load[0].node: missing; give the loaded node"}},
      {"negative frequency",
       {{"angular_frequency = 6.0", "angular_frequency = -6.0 #!"}},
       {"load[0].angular_frequency = -6.0: must be >= 0 (rad/s)"}},
      {"unknown displacement",
       {{"dof = \"u\"\namplitude", "dof = \"q\" #!\namplitude"}},
       {"load[0].dof = \"q\": must be one of \"u\", \"theta\""}},
      {"load on a support",
       {{"node = \"string:2\"", "node = \"string:4\" #!"}},
       {"load[0].node = \"string:4\": u of string:4 is fixed by a [[support]], so a load there has no effect"}},
      {"moment on a lone mass",
       {{"node = \"string:2\"\ndof = \"u\"", "node = \"rotor\"\ndof = \"theta\" #!"}},
       {"load[0].dof = \"theta\": theta of rotor does not exist: no element there uses it"}},
      {"ramp that ends before it starts",
       {{kLoad, "type = \"ramp\"\nnode = \"string:2\"\nto = 3\nstart = 0.5\nend = 0.25 #!"}},
       {"load[0].end = 0.25: must be later than start"}},
      {"times not ascending",
       {{kLoad, "type = \"table\"\nnode = \"string:2\"\ntimes = [0, 2, 1] #!\nvalues = [0, 1, 2]"}},
       {"load[0].times = [0, 2, 1]: must ascend: every instant later than the one before"}},
      {"times and values of two lengths",
       {{kLoad, "type = \"table\"\nnode = \"string:2\"\ntimes = [0, 1, 2]\nvalues = [0, 1] #!"}},
       {"load[0].values = [0, 1]: must hold as many values as there are times (3)"}},
      {"values not finite",
       {{kLoad, "type = \"table\"\nnode = \"string:2\"\ntimes = [0, 1]\nvalues = [0, -inf] #!"}},
       {"load[0].values = [0, -inf]: entry 1 (counted from 0): must be a finite number (N)"}},
      {"table without entries",
       {{kLoad, "type = \"table\"\nnode = \"string:2\"\ntimes = [] #!\nvalues = []"}},
       {"load[0].times = []: must hold at least one instant"}},
      {"distributed on a mass",
       {{kLoad, "type = \"distributed\"\nbeam = \"rotor\" #!\nvalue = 2"}},
       {"load[0].beam = \"rotor\": is not a beam; known: string"}},
      {"distributed on nothing",
       {{kLoad, "type = \"distributed\"\nbeam = \"strings\" #!\nvalue = 2"}},
       {"load[0].beam = \"strings\": there is no such beam (did you mean \"string\"?); known: string"}},
      {"distributed in a wrong time",
       {{kLoad, "type = \"distributed\"\nbeam = \"string\"\nvalue = 2\nin_time = { type = \"rmp\", to = 1 } #!"}},
       {"load[0].in_time.type = \"rmp\": must be one of \"harmonic\"", "(did you mean \"ramp\"?)"}},
      {"distributed on a beam with a mistake of its own",
       {{"material = \"steel\"", "material = \"iron\" #!"},
        {kLoad, "type = \"distributed\"\nbeam = \"string\"\nvalue = 2"}},
       {"element[0].material = \"iron\": there is no [material.iron]; known: steel"}},
      {"initial value on a support",
       {initial(
           "displacement = [\n  { nodes = \"rotor\", value = 0 },\n  { nodes = \"string:0\", value = 0.1 }, #!\n]")},
       {"initial.displacement[1].nodes = \"string:0\": u of string:0 is fixed by a [[support]], so an initial value "
        "there "
        "has no effect"}},
      {"initial turning of a lone mass",
       {initial("velocity = [{ nodes = \"rotor\", dof = \"theta\", value = 0.1 }] #!")},
       {"initial.velocity[0].dof = \"theta\": theta of rotor does not exist"}},
      {"two initial values for one DOF",
       {initial("velocity = [{ nodes = \"rotor\", value = 0.1 }, { nodes = \"rotor\", value = 0.2 }] #!")},
       {"initial.velocity[1].nodes = \"rotor\": gives u of rotor a second initial velocity"}},
      {"initial value beyond numbers",
       {initial("velocity = [{ nodes = \"rotor\", value = 1e300 }] #!")},
       {"initial.velocity[0].value = 1e+300: gives u of rotor an initial velocity of 1e+300; it must be at most "
        "1e+100"}},
      {"initial value missing",
       {initial("velocity = [{ nodes = \"rotor\" }] #!")},
       {"initial.velocity[0].value: missing; give the value (number, m/s)"}},
      {"initial values of an unknown kind",
       {initial(
           "displacment = [{ nodes = \"rotor\", value = 1 }] #!\nvelocity = [{ nodes = \"roto\", value = 1 }] #!")},
       {"initial.displacment = [{ nodes = \"rotor\", value = 1 }]: unknown key (did you mean \"displacement\"?)",
        "initial.velocity[0].nodes = \"roto\": \"roto\": there is no node"}},
      {"initial values that are no list",
       {initial("displacement = 0.1 #!")},
       {"initial.displacement = 0.1: must be a table, not a number"}},
  };
}

}  // namespace butee::test
