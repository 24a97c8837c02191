#include "butee/study/team.hpp"

#include <cstdlib>
#include <string>

#include "butee/core/error.hpp"
#include "butee/study/extension.hpp"

namespace butee::study {
namespace {

/// The number of processes started together with this one, from the environment; 1 if it gives
/// none.
int process_count() {
  // Open MPI; MPICH and related libraries; srun with an MPI plugin, which gives its tasks a rank of
  // PMIx or PMI.
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"})
    if (const char* text = std::getenv(name)) return std::atoi(text);
  if (std::getenv("PMIX_RANK") != nullptr)
    if (const char* text = std::getenv("SLURM_STEP_NUM_TASKS")) return std::atoi(text);
  return 1;
}

}  // namespace

std::unique_ptr<Team> join_team() {
  const int count = process_count();
  if (count <= 1) return nullptr;
  const Maker make = find_extension("study_mpi", "butee_study_mpi");
  if (make == nullptr)
    throw InputError("mpirun started " + std::to_string(count) +
                     " processes, but the module study_mpi is not installed, so that each would do the whole study; "
                     "install MPI (Debian: libopenmpi-dev) and build butee again, or take --shard I/N");
  return std::unique_ptr<Team>(static_cast<Team*>(make()));
}

}  // namespace butee::study
