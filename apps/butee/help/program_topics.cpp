#include "topics.hpp"

namespace butee::app::help {

const std::vector<Topic>& topics() {
  static const std::vector<Topic> all = {
      {"model", "contents of a scene file", model_text},
      {"selectors", "how nodes are named", selectors_text},
      {"elements", "beams, masses, springs, cross-sections and their keys", elements_text},
      {"space", "two planes and space, rotation, gravity, base motion", space_text},
      {"contact", "stops, rings, planes, friction and their laws", contact_text},
      {"loads", "forces and moments over time", loads_text},
      {"damping", "Rayleigh and modal damping", damping_text},
      {"integrators", "time integration methods and their choice", integrators_text},
      {"methods", "error bound for a given tolerance, and the methods that keep it", methods_text},
      {"output", "rows, probes, energy, impacts", output_text},
      {"results", "the files that a run writes", results_text},
      {"limits", "kinds of problems that butee does not solve", limits_text},
      {"study", "many runs of a scene whose keys vary", study_text},
      {"compare", "run time against error of several methods", compare_text},
      {"trust", "accuracy of a result, and whether the motion is chaotic", trust_text},
      {"plugins", "modules: where they are found, how to write one", plugins_text},
      {"exit-codes", "exit status of the program", exit_codes_text},
      {"environment", "environment variables", environment_text},
  };
  return all;
}

std::string methods_text(const plugin::Catalogue&) {
  return R"(For auto, exponential, rodas4, dopri5, extrapolation8 and for bathe_, generalized_alpha_, hht_alpha_,
discrete_gradient_ and central_differences_adaptive, `tolerance` guarantees an error bound for every displacement,
every rotation and their velocities:

  scale S     the largest value of the component so far, at least a thousandth of the largest of its kind in the run
  error e     the largest |error|/S of all components
              (beside a moving base: of the motion relative to it; of that in space with frame = "space" or nodes)
  growth G    the largest e/tolerance caused by a disturbance of the size of the tolerance at any earlier time

  e <= 10 tolerance max(1, G) at every output of a run of end_time.

Near a contact change the bound for velocities allows a time shift of 10 tolerance S/|w'|, w' being the speed of the
stop. For a longer end_time steps are shorter, because period errors accumulate. After end_time, in a structure that
another program advances, the error continues to grow at the same rate. The smallest tolerances are 1e-6 for methods
of order 2, 1e-8 for exponential with elastic stops, otherwise 1e-10 as for auto and
rodas4, 1e-11 for dopri5 and 1e-12 for extrapolation8. Smaller tolerances are refused because of rounding, the number
of steps or the accumulated errors of many impacts.

Exceptions: for structures of more than 600 DOFs the tolerance limits the error of each step, for any number of steps,
in the norm of the mass matrix over the whole structure. In a static position velocities below 1e-10 of the highest
frequency times the displacements are rounding and not controlled. exact and piecewise have no truncation error.
newmark_adaptive, newmark_modified_adaptive, rk4_fixed_factors, rk4_error_scaled and sundials control the error in the
way of their sources or libraries. `butee run --trust` bounds the error of a run, whatever the method.
)";
}

std::string results_text(const plugin::Catalogue&) {
  return R"(`butee run MODEL.toml` writes into MODEL-results, or into the folder given by -o:

  history.csv    t, the probes' columns, h (the current step size); 17 digits
  summary.json   status, counters of operations, times, peaks, energies
  model.toml     the scene as run, with the changes of --set
  states.bin     the motion of all nodes at the end of a completed run and at the instants of [output] states, as a
                 start for [initial] from of another scene; binary, read only by butee
  impacts.csv    if [output] impacts = true: node, side, t_in, t_out, peak_force, impulse, impact_speed,
                 tangential_impulse (N s), slip (m) and dissipated (J), the last three are 0 for elastic stops;
                 dof: u, theta, uz, ... of a stop, empty for a ring or plane
  wear.csv       of contacts in the plane, with dissipation or friction: work (J, the integral of |F_n w|) and mean_power,
                 contact_share (of the time), slip (m), dissipated (J), peak and rms normal force (N)
  energy.csv     if [output] energy = true: t, kinetic, strain, contact, work, dissipated (J)
  fields.h5, fields.xdmf
                 if formats contains "hdf5": the fields of all nodes, for ParaView and h5py; its group /probes has the
                 columns of history.csv, each with its unit
  plots/         with --plot, or by `butee plot DIR`: pictures, each with its gnuplot script
  checkpoint.bin, checkpoint-before.bin
                 if [output] checkpoint = N, until the run is completed: butee run --resume DIR continues from them
  .butee-lock    while a run writes there; a second run into the same folder is refused

Columns of history.csv are LABEL.QUANTITY: m, m/s, m/s2, N; rad, rad/s and rad/s2 of theta, which is du/dx. The
counters of summary.json count operations; factor_updates is always 0, because no factorization is changed in place.

model.toml names the files that the scene reads (file, from) relative to its own folder, with size and checksum: if
one of them has changed, running model.toml again is refused.

A peak is the largest |value| over the whole motion, including the time between steps and rows: a stationary point of
the method's own dense output, found to 1e-10 of it (the sum of several stops on a node to 1e-6), so its accuracy is
that of the run. For normal_force, friction_force, slip, wear_power and motion under [base] in the other frame (u_abs,
v_abs, a_abs; with frame = "space" u, v, a instead) it is searched from samples of that output. For forces of elements
(M, V, stresses, spring forces, reactions) it is the largest |value| of the rows. Beside stops `exponential` may miss
peaks of accelerations between rows in modes that turn by several radians in a step, and of velocities by 5e-3.
If a node has one stop that does not pull, the largest peak_force of impacts.csv, the largest force of compression, is
the peak of contact_force, which is the force along u or, if no contact acts along u, along the DOF of the first
contact; contact_ux ... contact_rz are those along each DOF.

Work and dissipation, with energy = true, are integrals over that output; each row of energy.csv is at the instant of an
output or, with methods of short steps, at the first end of a step after it. Where u is measured in space while supports
move ([[base]] nodes, or frame = "space"), the work includes that of the forces on the supports. Under a [base] that all
else is relative to, energies are those of the motion relative to it, and the work is that of the inertia forces.

Files of an earlier run in the folder are replaced, other files stay; a folder that is not empty and was not created by
butee is refused. A run that fails keeps its partial results, in whole lines, and reports the failure in summary.json.

`butee modes -o DIR` writes frequencies.csv and shapes.csv: node, coordinate, and u and theta of each mode (and ux,
uz, rx, ry if the scene has them), scaled so that the modal mass is 1 kg.
)";
}

std::string limits_text(const plugin::Catalogue&) {
  return R"(butee solves small motions of linear structures, in the plane or in space, whose only nonlinearity is contact. It does not have:

  Structures   plates, shells, solids; shafts that turn about another axis than x, or whose section has two stiffnesses; the
               torque of a run-up on rx; axial forces that change with the motion (a preload is a constant)
  Large motion large rotations, stress stiffening, motion after buckling
  Materials    plasticity, creep, fatigue; damping beyond Rayleigh's, modal damping, bearings and dashpots
  Contact      in three directions at once; at places that move along a beam, or between surfaces; rigid stick in a ring;
               stops that press at rest (a gap below 0), or between a body and a support that moves by itself
  Loads        forces that depend on the motion, moving loads; jumps in a table (two values at one instant)
  Results      stresses of transverse shear, of torsion in sections that are not round; fatigue; optimal parameters; static
               solutions without a run

A motion that strikes stops may be chaotic: then no method can predict the motion for long (butee help trust). Scenes
are limited by memory; butee check tells how much is needed. New elements, laws, contacts and loads come as modules
(butee help plugins).
)";
}

std::string compare_text(const plugin::Catalogue&) {
  return R"(`butee compare MODEL.toml` runs every installed method from coarse to fine, and writes into MODEL-compare
report.md (the fastest method for each target error), runs.csv and a picture (if gnuplot is installed). The reference
is the method `exact`, computed twice, so that the uncertainty of the reference is known. Ctrl-C keeps completed runs;
the same command continues, --fresh starts again.

A study defines the comparison in detail:

  schema = 1
  [study]
  title      = "stiff stops"
  scenes     = ["scene.toml"]                   # beside the study
  quantity   = ["mid.u"]                        # columns of history.csv
  end_time   = 0.3                              # s
  targets    = [1.0e-2, 1.0e-3]                 # relative rms errors
  [[study.method]]                              # default: all methods
  type   = "newmark"
  sweep  = "time_step"
  values = [1.0e-3, 5.0e-4]
)";
}

std::string trust_text(const plugin::Catalogue&) {
  return R"(`butee run --trust`, or [output] trust = true, runs the scene again: as it is, with half the step or a
tenth of the tolerance, by a method of another family (`exact` where it can), and from disturbed states. It prints an
error bound of the probes' displacements and rotations, the time up to which this bound is within trust_accuracy (1 %
of the peak), the growth of small differences, whether the motion is chaotic, and bounds of rms values (of the
instants at which it compares the runs), peaks and forces. Velocities and accelerations are not judged row by row. summary.json contains the same under `trust`. It takes
ten times as long as the run or longer, since the other method is far more accurate: seconds for runs of milliseconds.
If no method of another family can run the scene within a bound of its work, a message says so and the bound is wider.

Motion against stops is often chaotic: differences grow like e^(20 t) in one of the paper's scenes. Then no method can
predict the motion for long, while peaks and rms values may still be accurate.
)";
}

std::string plugins_text(const plugin::Catalogue& catalogue) {
  return "Methods are modules: shared objects, each with a manifest file that gives names and parameters without\n"
         "loading the module; only the module that a scene names is loaded. Modules may also provide laws, contacts,\n"
         "loads and elements. " +
         std::to_string(catalogue.integrators().size()) + " methods are installed here.\n" +
         R"(
They are searched for in butee/plugins beside the library, in the folders of BUTEE_PLUGIN_PATH (separated by ':'), and in
FILE or DIR of --plugin FILE|DIR.

  butee plugins           all names that a scene may use
  butee plugins NAME      its parameters with units and defaults
  butee plugins --json    the same for scripts

One algorithm file and an entry file of a few lines make a module:

  find_package(butee REQUIRED)
  butee_add_plugin(my_method plugin.cpp my_method.cpp)

  #include <butee/plugin/entry.hpp>
  BUTEE_PLUGIN(registrar) { registrar.add(my_method_type()); }   // a butee::time::IntegratorType
)";
}

std::string exit_codes_text(const plugin::Catalogue&) {
  return R"(  0   done
  1   the run failed numerically, or a file could not be written; partial results are kept; summary.json gives the reason
  2   bad input or usage: messages on standard error, nothing is written

Errors and warnings go to standard error, results to standard output, which stays usable in a pipe.
)";
}

std::string environment_text(const plugin::Catalogue&) {
  return R"(  BUTEE_PLUGIN_PATH   folders with further modules, separated by ':'
  BUTEE_TARGET        the instruction set of the kernels: one that `butee --version` lists, such as avx2; without it,
                      the best one of the processor. Results of different sets differ in their last digits, and a
                      run resumes from a checkpoint only with the set that wrote it
  NO_COLOR            if set, no colours; otherwise colours only on a terminal
  LC_ALL, LC_CTYPE, LANG
                      with UTF-8, `butee check` draws with line-drawing characters, otherwise with plain ones
)";
}

}  // namespace butee::app::help
