#include <mpi.h>

#include <butee/core/error.hpp>
#include <butee/plugin/entry.hpp>
#include <butee/study/team.hpp>

namespace butee::plugins::study_mpi {
namespace {

/// All processes of MPI_COMM_WORLD. Only the thread that made it calls MPI.
class World final : public study::Team {
 public:
  World() {
    int provided = 0;
    if (MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided) != MPI_SUCCESS)
      throw RunError("MPI cannot be started");
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
  }
  ~World() override { MPI_Finalize(); }
  int rank() const override { return rank_; }
  int size() const override { return size_; }
  int agree(int status) override {
    int largest = status;
    if (MPI_Allreduce(&status, &largest, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD) != MPI_SUCCESS)
      throw RunError("MPI: a process of the study is gone");
    return largest;
  }

 private:
  int rank_ = 0, size_ = 1;
};

}  // namespace
}  // namespace butee::plugins::study_mpi

BUTEE_PLUGIN(registrar) {
  (void)registrar;  // It has no types: studies ask for the function below.
}

extern "C" __attribute__((visibility("default"))) void* butee_study_mpi() {
  return static_cast<butee::study::Team*>(new butee::plugins::study_mpi::World);
}
