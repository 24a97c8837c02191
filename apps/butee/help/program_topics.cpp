#include "topics.hpp"

namespace butee::app::help {

const std::vector<Topic>& topics() {
  static const std::vector<Topic> all = {
      {"model", "what a scene file holds", model_text},
      {"selectors", "how nodes are named", selectors_text},
      {"elements", "beams, masses, springs, cross-sections and their keys", elements_text},
      {"space", "two planes and space, rotation, gravity, base motion", space_text},
      {"contact", "stops, rings, planes, friction and their laws", contact_text},
      {"loads", "forces and moments over time", loads_text},
      {"damping", "Rayleigh and modal damping", damping_text},
      {"integrators", "the methods, and how one is chosen", integrators_text},
      {"methods", "what a tolerance promises, and which methods keep it", methods_text},
      {"output", "rows, probes, energy, impacts", output_text},
      {"results", "the files that a run writes", results_text},
      {"limits", "kinds of problems that butee does not solve", limits_text},
      {"study", "many runs of a scene whose keys vary", study_text},
      {"compare", "run time against error of several methods", compare_text},
      {"trust", "how far an answer can be trusted", trust_text},
      {"plugins", "modules: where they are found, how to write one", plugins_text},
      {"exit-codes", "what the program returns", exit_codes_text},
      {"environment", "variables that the program looks at", environment_text},
  };
  return all;
}

std::string methods_text(const plugin::Catalogue&) {
  return R"(`tolerance` of auto, exponential, rodas4, dopri5, extrapolation8 and of bathe_, generalized_alpha_, hht_alpha_,
discrete_gradient_ and central_differences_adaptive is a promise about every displacement, every rotation and their
velocities:

  scale S     the largest value of the component so far, at least a thousandth of the largest of its kind in the run
  error e     the largest |error|/S of all components
  growth G    the largest e/tolerance that disturbances of the size of the tolerance cause, put in at any time before

  e <= 10 tolerance max(1, G) at every output of a run of end_time.

Velocities near a change of contact are meant within 10 tolerance S/|w'| of time. Steps become shorter where end_time is
longer, since errors of the period add up. Beyond end_time, in a structure that another program advances, the error goes on
to grow at the same rate. The smallest tolerances are 1e-6 for methods of order 2, 1e-8 for exponential where stops
act on modes that no damping couples, else 1e-10 as for auto and rodas4, 1e-11 for dopri5 and 1e-12 for extrapolation8;
below them rounding or the number of steps leaves no use, or errors of many impacts add up, and a scene is refused.

Exceptions: structures of more than 600 DOFs are measured as a whole, in the norm of the mass matrix, and every step is
held to the tolerance, whatever their number. exact and piecewise have no truncation error. newmark_adaptive,
newmark_modified_adaptive, rk4_fixed_factors, rk4_error_scaled and sundials control what their sources or libraries control.
`butee run --trust` bounds the error of a run, whatever the method.
)";
}

std::string results_text(const plugin::Catalogue&) {
  return R"(`butee run MODEL.toml` writes into MODEL-results, or where -o says:

  history.csv    t, the probes' columns, h (the step in force); 17 digits
  summary.json   status, counters of what was really done, times, peaks, energies
  model.toml     the scene as run, with what --set changed
  states.bin     the motion of all nodes at the end and at the instants of [output] states, of a completed run: where
                 [initial] from of another scene starts; binary, for butee alone
  impacts.csv    where [output] impacts = true: node, side, t_in, t_out, peak_force, impulse, impact_speed,
                 tangential_impulse (N s), slip (m) and dissipated (J), the last three 0 of elastic stops
  wear.csv       of contacts in the plane, with dissipation or friction: work (J, the integral of |F_n w|) and mean_power,
                 contact_share (of the time), slip (m), dissipated (J), peak and rms normal force (N)
  energy.csv     where [output] energy = true: t, kinetic, strain, contact, work, dissipated (J)
  fields.h5, fields.xdmf
                 where formats holds "hdf5": the fields of all nodes, for ParaView and h5py; its group /probes has the
                 columns of history.csv, each with its unit
  plots/         with --plot, or by `butee plot DIR`: pictures, each with its gnuplot script
  checkpoint.bin, checkpoint-before.bin
                 where [output] checkpoint = N, until the run is completed: butee run --resume DIR goes on from them
  .butee-lock    while a run writes there; a second run into the same folder is refused

Columns of history.csv are LABEL.QUANTITY: m, m/s, m/s2, N; rad, rad/s and rad/s2 of theta, which is du/dx. The
counters of summary.json count what was done; factor_updates is always 0, since no factorization is changed in place.

model.toml names the files that the scene reads (file, from) as they are found from its folder, with size and checksum: where
one has changed since, running model.toml again is refused.

A peak is the largest |value| over the whole motion, between steps and rows too: a stationary point of the method's own
dense output, found to 1e-10 of it (the sum of several stops on a node to 1e-6), so that it is as good as the run. Of
normal_force, friction_force, slip and wear_power it is looked for between eight instants of a step. Of forces of elements
(M, V, stresses, spring forces, reactions) it is the largest |value| of the rows. The largest peak_force
of impacts.csv is the peak of contact_force where a node has one stop. Work and dissipation, with energy = true, are
integrals over that output; a row of energy.csv stands at the end of a step.

Files of an earlier run there are replaced, anything else in the folder stays; a folder that is not empty and was not made by
butee is refused. A run that fails keeps what was computed, in whole lines, and says so in summary.json.

`butee modes -o DIR` writes frequencies.csv and shapes.csv: node, coordinate, and u and theta of each mode (and ux, uz, rx, ry
where the scene has them), scaled so that the modal mass is 1 kg.
)";
}

std::string limits_text(const plugin::Catalogue&) {
  return R"(butee solves small motions of linear structures, in the plane or in space, whose only nonlinearity is contact. It does not have:

  Structures   plates, shells, solids; shafts that turn about another axis than x, or whose section has two stiffnesses;
               axial forces that change with the motion (a preload is a constant)
  Large motion large rotations, stress stiffening, motion after buckling
  Materials    plasticity, creep, fatigue; damping beyond Rayleigh's, modal damping, bearings and dashpots
  Contact      in three directions at once; at places that move along a beam, or between surfaces; rigid stick in a ring
  Loads        forces that depend on the motion, moving loads
  Results      stresses of transverse shear, of torsion in sections that are not round; fatigue; optimal parameters; static
               solutions without a run

A motion that strikes stops may be chaotic: then no method can give its course for long (butee help trust). Scenes are
limited by memory: butee check says how much one takes. New elements, laws, contacts and loads come as modules (butee help plugins).
)";
}

std::string compare_text(const plugin::Catalogue&) {
  return R"(`butee compare MODEL.toml` runs every method that is installed from coarse to fine, and writes into MODEL-compare report.md (the
fastest method for each target error), runs.csv and a picture (where gnuplot is installed). Errors are taken against the method
`exact`, computed twice, so that the reference knows its own uncertainty. Ctrl-C keeps what is done; the same command goes on from
there, --fresh begins anew.

A study says more precisely what is compared:

  schema = 1
  [study]
  title      = "stiff stops"
  scenes     = ["scene.toml"]                   # beside the study
  quantity   = ["mid.u"]                        # columns of history.csv
  end_time   = 0.3                              # s
  targets    = [1.0e-2, 1.0e-3]                 # relative rms errors
  [[study.method]]                              # all methods where there is none
  type   = "newmark"
  sweep  = "time_step"
  values = [1.0e-3, 5.0e-4]
)";
}

std::string trust_text(const plugin::Catalogue&) {
  return R"(`butee run --trust`, or [output] trust = true, runs the scene again: as it is, with half the step or a tenth of the tolerance,
by a method of another family (`exact` where it can), and from disturbed states. It says by how much the probes can be wrong,
up to which time that is within trust_accuracy (1 % of the peak), how far small differences grow, whether that is chaos, and
between which bounds rms values, peaks and forces lie. summary.json holds the same under `trust`. It takes about ten times as long
as the run; where no method of another family does with a few times the run's work, it says so, and its bound is wider.

Motion against stops is often chaotic: differences grow like e^(20 t) in one of the paper's scenes, so that no method holds its
course for long, while peaks and rms values may still be right.
)";
}

std::string plugins_text(const plugin::Catalogue& catalogue) {
  return "Methods are modules: shared objects with a manifest beside each, so that names and parameters are known "
         "without "
         "loading\nany; only the module that a scene names is loaded. Modules may bring laws, contacts, loads and "
         "elements as "
         "well. " +
         std::to_string(catalogue.integrators().size()) + " methods are\ninstalled here.\n" +
         R"(
They are looked for in butee/plugins beside the library, in the folders of BUTEE_PLUGIN_PATH (parted by ':'), and where
--plugin FILE|DIR says.

  butee plugins           all that a scene may name
  butee plugins NAME      its parameters with units and defaults
  butee plugins --json    the same for scripts

One algorithm file and a door of a few lines make a module:

  find_package(butee REQUIRED)
  butee_add_plugin(my_method plugin.cpp my_method.cpp)

  #include <butee/plugin/entry.hpp>
  BUTEE_PLUGIN(registrar) { registrar.add(my_method_type()); }   // a butee::time::IntegratorType
)";
}

std::string exit_codes_text(const plugin::Catalogue&) {
  return R"(  0   done
  1   the run failed numerically, or a file could not be written; what was computed is kept, and summary.json says why
  2   bad input or usage: messages on standard error, nothing is written

Errors and warnings go to standard error, results to standard output, which stays usable in a pipe.
)";
}

std::string environment_text(const plugin::Catalogue&) {
  return R"(  BUTEE_PLUGIN_PATH   folders with further modules, parted by ':'
  BUTEE_TARGET        the instruction set of the kernels: one that `butee --version` lists, such as avx2; without it,
                      the best that the processor has. Results of different sets differ in their last digits, and a
                      run goes on from a checkpoint only with the set that wrote it
  NO_COLOR            where set, no colours; elsewhere there are none but on a terminal
  LC_ALL, LC_CTYPE, LANG
                      with UTF-8, `butee check` draws with line-drawing characters, otherwise with plain ones
)";
}

}  // namespace butee::app::help
