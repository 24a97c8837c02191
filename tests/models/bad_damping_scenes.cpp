#include "bad_scenes.hpp"

namespace butee::test {

std::vector<BadScene> bad_damping_scenes() {
  const std::string rayleigh = "mass_proportional = 0.03";
  const auto modal = [&](const std::string& value) { return Edit{rayleigh, "modal = " + value + " #!"}; };
  return {
      {"negative damping",
       {{"mass_proportional = 0.03", "mass_proportional = -0.03 #!"}},
       {"damping.mass_proportional = -0.03: must be >= 0 (1/s)"}},
      {"unknown key of the damping",
       {{"mass_proportional = 0.03", "mass_proportionl = 0.03 #!"}},
       {"damping.mass_proportionl = 0.03: unknown key (did you mean \"mass_proportional\"?)"}},
      {"damping beyond numbers",
       {{rayleigh, "mass_proportional = 1e300 #!"}},
       {"damping.mass_proportional = 1e+300: at most 1e+40 1/s can be computed; it is in 1/s, such as 1"}},
      {"damping by the stiffness beyond numbers",
       {{rayleigh, "stiffness_proportional = 1e300 #!"}},
       {"damping.stiffness_proportional = 1e+300: damps motion faster than 1e+40 1/s",
        "it is in seconds, such as 1e-6"}},
      {"damping written as an array",
       {{"[damping]", "[[damping]] #!"}},
       {"damping = [{ mass_proportional = 0.03 }]: must be a table, not an array"}},
      {"modal beside Rayleigh damping",
       {{rayleigh, rayleigh + "\nmodal = 0.02 #!"}},
       {"damping.modal = 0.02: replaces mass_proportional and stiffness_proportional; remove it, or those"}},
      {"modal beside Rayleigh damping by the stiffness, and itself wrong",
       {{rayleigh, "stiffness_proportional = 0\nmodal = -0.02 #!!"}},
       {"damping.modal = -0.02: replaces", "damping.modal = -0.02: must be >= 0"}},
      {"modal a text",
       {modal("\"2 %\"")},
       {"damping.modal = \"2 %\": must be a number, the damping ratio of every mode, or an array of numbers, those of "
        "the lowest modes, not a string"}},
      {"modal not a number", {modal("nan")}, {"damping.modal = nan: must be a finite number"}},
      {"modal an empty array", {modal("[]")}, {"damping.modal = []: names no mode"}},
      {"modal with a negative ratio",
       {modal("[0.02, -0.01]")},
       {"damping.modal = [0.02, -0.01]: entry 1 (counted from 0): must be >= 0"}},
      {"modal with a text among its ratios",
       {modal("[0.02, \"0.01\"]")},
       {"entry 1 (counted from 0): must be a number, not a string"}},
      {"modal with more ratios than modes",
       {modal("[0, 0, 0, 0, 0, 0, 0, 0, 0, 0.1]")},
       {"has ratios for 10 modes, but the scene has only 9 modes, one for each free DOF"}},
      {"modal of every mode of a large system",
       {{"elements = 4", "elements = 600"}, modal("0.02")},
       {"damping.modal = 0.02: one ratio for every mode is for systems of at most 1000 free DOFs, and this one has "
        "1201; give an array of ratios for its lowest modes, the others are then not damped"}},
      {"modal misspelt",
       {{rayleigh, "model = 0.02 #!"}},
       {"damping.model = 0.02: unknown key (did you mean \"modal\"?)"}},
  };
}

}  // namespace butee::test
