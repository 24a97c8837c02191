#include <butee/study/collect.hpp>

#include "topics.hpp"

namespace butee::app::help {

std::string study_text(const plugin::Catalogue&) {
  std::string text =
      R"(`butee study STUDY.toml` runs a scene at many points, on all processors, and keeps a row of results for each run in
STUDY-study/study.h5, or study.csv where HDF5 is not installed (--format csv). `butee check STUDY.toml` says how many runs
there are, how long they take and how large the rows become.

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
                                   # final motion of the one before, stick and slip of contacts included; "up", "down"
  settle  = 1440                   # periods before results count
  periods = 60                     # periods that count; without, a run lasts to end_time of the scene
  steady  = 1.0e-5                 # settle ends earlier where the motion repeats itself, after 1 to 16 periods, to this
                                   # part of it; the column `settled` says when
  period  = 0.02                   # s; without, that of the loads
  set     = ["contact[0].gap=0"]   # overrides of the scene for all runs
  collect = ["section rotor.u", "peak rotor.u", "impacts"]

Results that `collect` takes, of a probe of the scene by its label, or of a node:

)";
  for (const study::ItemKind& kind : study::item_kinds())
    text +=
        "  " + kind.name + std::string(kind.name.size() < 11 ? 11 - kind.name.size() : 1, ' ') + kind.summary + "\n";
  text += R"(
Rows have the values of the keys, status (completed, failed, refused) with its reason, the results, a checksum of the
scene, and what the run cost. They depend neither on the number of threads nor on the order; cost and times do.
lyapunov takes two further runs over the periods that count, and neglects what a law remembers between them. trust takes
several, from the scene's own start, so that it does not go with follow.

Killed or interrupted, the same command goes on with what is left. Where scene, study or butee have changed since, it
refuses; --fresh begins anew. While it runs, rows-*.h5 can be read (h5py.File(name, "r", swmr=True)["rows"]), and all
rows of processes and shards together by butee.Study.load(DIR) of the Python package.

  --plot              bifurcation diagram, response curve, map over two keys, Poincare section, histogram, into DIR/plots
                      (butee plot DIR draws them again, and those of a study that is under way)
  --shard I/N         one of N parts, of a job array; --merge then puts all rows together
  mpirun -n N butee study STUDY.toml         by processes that take points as they finish others, where the module study_mpi
                                             is installed
  --points FILE|- --results FILE|-           points as CSV with a line of keys, rows as CSV in their order: for OpenTURNS,
                                             Dakota or a shell that asks for one point after the other
)";
  return text;
}

}  // namespace butee::app::help
