#include "bad_scenes.hpp"

namespace butee::test {
namespace {

Edit tables(const std::string& text) {
  return {"[output]", text + "\n[output]"};
}

}  // namespace

std::vector<BadScene> bad_integrator_scenes() {
  const std::string type = "type = \"newmark_modified\"", step = "time_step = 1.0e-5";
  const Edit zienkiewicz_xie = {type,
                                "type = \"NM2\"\nresidual_tolerance = 1e-9\nincrement_tolerance = 1e-9\nmax_iterations "
                                "= 10\ntarget_error = 1e-2"};
  return {
      {"unknown integrator",
       {{type, "type = \"NMM3\" #!"}},
       {"integrator.type = \"NMM3\": there is no such integrator (did you mean \"NMM1\"?); known: ", "newmark_modified",
        "RK4-3"}},
      {"integrator's name a number",
       {{type, "type = 4 #!"}},
       {"integrator.type = 4: must be a string, not an integer; known: "}},
      {"a method's key without its name",
       {{"[integrator]\n" + type, "[integrator]\nbeta = 0.3 #!"}},
       {"integrator.beta = 0.3: is no parameter of auto; it belongs to newmark"}},
      {"no integrator",
       {{"schema = 1", "schema = 1 #!"}, {"[integrator]\n" + type + "\n" + step + "\nend_time = 1.0", ""}},
       {"integrator: missing; give [integrator] with end_time, and with type"}},
      {"integrator written as an array",
       {{"[integrator]", "[[integrator]] #!"}},
       {"integrator = [{ type = \"newmark_modified\"", "must be a table, not an array"}},
      {"no step", {{step, "time_step = 0 #!"}}, {"integrator.time_step = 0: must be > 0 (s)"}},
      {"step beyond the end",
       {{step, "time_step = 2 #!"}},
       {"integrator.time_step = 2: must not be larger than end_time = 1.0 s"}},
      {"step lost in rounding",
       {{step, "time_step = 1e-17 #!"}},
       {"integrator.time_step = 1e-17: is lost in rounding relative to end_time = 1.0 s"}},
      {"end not finite",
       {{"end_time = 1.0", "end_time = inf #!"}},
       {"integrator.end_time = inf: must be a finite number"}},
      {"step and end missing",
       {{"[integrator]", "[integrator] #!!"}, {step, ""}, {"end_time = 1.0", ""}},
       {"integrator.time_step: missing", "integrator.end_time: missing"}},
      {"step a table",
       {{step, "time_step = { first = 1 } #!"}},
       {"integrator.time_step = { first = 1 }: must be a number, not a table"}},
      {"unknown key",
       {{step, "time_stp = 1.0e-5 #!"}},
       {"integrator.time_stp = 1e-05: unknown key (did you mean \"time_step\"?); known here: time_step, end_time, "}},
      {"key of other methods",
       {{step, step + "\nmax_iterations = 10 #!"}},
       {"integrator.max_iterations = 10: is no parameter of newmark_modified; it belongs to newmark, newmark_adaptive",
        "move it to a table [integrator.newmark]"}},
      {"unknown key beside a wrong step",
       {{step, "time_step = -1 #!\ncolour = 3 #!"}},
       {"integrator.time_step = -1: must be > 0 (s)", "integrator.colour = 3: unknown key"}},
      {"unknown integrator beside a wrong step",
       {{type, "type = \"newmrk\" #!"}, {step, "time_step = -1 #!"}},
       {"there is no such integrator (did you mean \"newmark\"?)", "integrator.time_step = -1: must be > 0 (s)"}},
      {"tables for a name and its alias",
       {tables("[integrator.newmark]\nbeta = 0.25\n[integrator.NM1] #!\nbeta = 0.3")},
       {"integrator.NM1: is a second table for newmark, whose names are newmark, NM1; keep one of the two"}},
      {"table of an unknown method",
       {tables("[integrator.newmarc] #!\nbeta = 0.25")},
       {"integrator.newmarc: there is no integrator of this name (did you mean \"newmark\"?); known: "}},
      {"wrong value in a table that is not used",
       {tables("[integrator.rk4_error_scaled]\ntolerance = -1 #!")},
       {"integrator.rk4_error_scaled.tolerance = -1: must be > 0"}},
      {"wrong value in the table that is used, reported once",
       {tables("[integrator.NMM1]\nbeta = \"quarter\" #!")},
       {"integrator.NMM1.beta = \"quarter\": must be a number, not a string"}},
      {"unknown key in a table that is not used",
       {tables("[integrator.NM2]\ntarget_eror = 1e-2 #!")},
       {"integrator.NM2.target_eror = 0.01: unknown key (did you mean \"target_error\"?); known here: "}},
      {"parameters of the chosen method missing",
       {{"[integrator]\n" + type, "[integrator] #!!\ntype = \"RK4-3\""}},
       {"integrator.tolerance: missing", "integrator.safety: missing"}},
      {"unknown policy",
       {{zienkiewicz_xie.find, zienkiewicz_xie.replace + "\non_newton_failure = \"kep\" #!"}},
       {"integrator.on_newton_failure = \"kep\": must be one of \"stop\", \"keep\" (did you mean \"keep\"?)"}},
      {"no iterations",
       {{type, "type = \"NM1\"\nresidual_tolerance = 1e-9\nincrement_tolerance = 1e-9\nmax_iterations = 0 #!"}},
       {"integrator.max_iterations = 0: must be >= 1"}},
      {"band without 1",
       {zienkiewicz_xie, {step, step + "\nband = [1.5, 4.0] #!"}},
       {"integrator.band = [1.5, 4.0]: must contain 1 between its two values"}},
      {"band of three",
       {zienkiewicz_xie, {step, step + "\nband = [0.5, 1.0, 4.0] #!"}},
       {"integrator.band = [0.5, 1.0, 4.0]: must hold 2 values, not 3"}},
      {"beta of one sixth",
       {zienkiewicz_xie, {step, step + "\nbeta = 0.16666666666666666 #!"}},
       {"integrator.beta = 0.16666666666666666: ", "1/6"}},
  };
}

}  // namespace butee::test
