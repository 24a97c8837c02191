#include <butee/study/collect.hpp>

#include "topics.hpp"

namespace butee::app::help {

std::string study_text(const plugin::Catalogue&) {
  std::string text =
      R"(`butee study STUDY.toml` runs a scene at many points, on all processors, and writes a row of results for
each run into STUDY-study/study.h5, or study.csv if HDF5 is not installed (--format csv). `butee check STUDY.toml`
prints the number of runs, their duration and the size of the rows.

  schema = 1
  scene  = "rattle.toml"           # beside the study
  title  = "Rattle"                # of pictures

  [[vary]]
  key     = "load[0].amplitude"    # any key that --set takes
  from    = 1000.0                 # from, to, count, spacing = "linear" | "log",
  to      = 30000.0                # or values = [...] (numbers or texts),
  count   = 291                    # or file = "points.csv" (a line of names) with column = "name"
  label   = "load / N"             # of its axis in pictures

  [study]
  plan    = "grid"                 # grid: all combinations, the last key the fastest; list: values one by one;
                                   # sobol, latin: `count` points spread over the ranges, with a `seed`
  follow  = false                  # true: sweeps along the last key, up and down, in which each run starts from the
                                   # final motion of the one before, stick and slip of contacts included; each sweep
                                   # begins with the scene's own start; "up", "down": one of them
  settle  = 1440                   # periods before results count
  periods = 60                     # periods that count; default: to end_time of the scene
  steady  = 1.0e-5                 # settling ends early if the motion repeats after 1 to 16 periods within this relative
                                   # difference; the column `settled` gives their number
  period  = 0.02                   # s; default: that of the loads
  set     = ["contact[0].gap=0"]   # overrides of the scene for all runs
  collect = ["section rotor.u", "peak rotor.u", "impacts"]

Results for `collect`, of a probe of the scene by its label, or of a node:

)";
  for (const study::ItemKind& kind : study::item_kinds())
    text +=
        "  " + kind.name + std::string(kind.name.size() < 11 ? 11 - kind.name.size() : 1, ' ') + kind.summary + "\n";
  text += R"(
Rows have the values of the keys, status (completed, failed, refused) with its reason, the results, a checksum of the
scene, and the cost of the run. They depend neither on the number of threads nor on the order; cost and times do.
lyapunov needs two further runs over the periods that count, and ignores the memory of contact laws; it is an average
over these periods, and its error falls with their number (a regular motion: about 1 / time). trust needs several,
from the scene's own start, and cannot be combined with follow.

After an interruption the same command performs the remaining runs. If scene, study or butee have changed since, it
refuses; --fresh starts again. While it runs, rows-*.h5 can be read (h5py.File(name, "r", swmr=True)["rows"]), and all
rows of processes and shards together by butee.Study.load(DIR) of the Python package.

  --plot              bifurcation diagram, response curve, map over two keys, Poincare section, histogram, into DIR/plots
                      (butee plot DIR draws them again, also while the study runs)
  --shard I/N         one of N parts, for a job array; --merge then joins all rows
  mpirun -n N butee study STUDY.toml         by processes that share the points dynamically, if the module study_mpi is
                                             installed
  --points FILE|- --results FILE|-           points as CSV with a line of keys, rows as CSV in their order: for OpenTURNS,
                                             Dakota or a shell that requests points one by one
)";
  return text;
}

}  // namespace butee::app::help
