#include <mpi.h>
#include <mutex>

#include <butee/core/error.hpp>
#include <butee/plugin/entry.hpp>
#include <butee/study/team.hpp>

namespace butee::plugins::study_mpi {
namespace {

/// All processes of MPI_COMM_WORLD. Threads call MPI one at a time. The shared counter is in the
/// memory of the first process; the others increment it by one-sided communication
/// (MPI_Fetch_and_op).
class World final : public study::Team {
 public:
  World() {
    int provided = 0;
    if (MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided) != MPI_SUCCESS)
      throw RunError("MPI cannot be started");
    if (provided < MPI_THREAD_SERIALIZED)
      throw RunError("this MPI does not let several threads call it (MPI_THREAD_SERIALIZED); take --shard I/N");
    MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
    void* memory = nullptr;
    check(MPI_Win_allocate(rank_ == 0 ? sizeof(std::int64_t) : 0, sizeof(std::int64_t), MPI_INFO_NULL, MPI_COMM_WORLD,
                           static_cast<void*>(&memory), &window_));
    MPI_Win_set_errhandler(window_, MPI_ERRORS_RETURN);
    check(MPI_Win_lock_all(MPI_MODE_NOCHECK, window_));
    if (rank_ == 0) {
      *static_cast<std::int64_t*>(memory) = 0;
      check(MPI_Win_sync(window_));
    }
    check(MPI_Barrier(MPI_COMM_WORLD));
  }
  ~World() override {
    MPI_Win_unlock_all(window_);
    MPI_Win_free(&window_);
    MPI_Finalize();
  }
  int rank() const override { return rank_; }
  int size() const override { return size_; }
  int agree(int status) override {
    const std::lock_guard guard(mutex_);
    int largest = status;
    check(MPI_Allreduce(&status, &largest, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD));
    return largest;
  }
  std::int64_t add(std::int64_t count) override {
    const std::lock_guard guard(mutex_);
    std::int64_t before = 0;
    check(MPI_Fetch_and_op(&count, &before, MPI_INT64_T, 0, 0, MPI_SUM, window_));
    check(MPI_Win_flush(0, window_));
    return before;
  }
  void serve() override {
    const std::lock_guard guard(mutex_);
    int is_there = 0;
    check(MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &is_there, MPI_STATUS_IGNORE));
  }

 private:
  static void check(int status) {
    if (status != MPI_SUCCESS) throw RunError("MPI: a process of the study has ended");
  }

  int rank_ = 0, size_ = 1;
  MPI_Win window_ = MPI_WIN_NULL;
  std::mutex mutex_;
};

}  // namespace
}  // namespace butee::plugins::study_mpi

BUTEE_PLUGIN(registrar) {
  (void)registrar;  // The module has no types; studies look up the function below.
}

extern "C" __attribute__((visibility("default"))) void* butee_study_mpi() {
  return static_cast<butee::study::Team*>(new butee::plugins::study_mpi::World);
}
