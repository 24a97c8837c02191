#pragma once

#include <cstdint>
#include <memory>

#include <butee/export.hpp>

namespace butee::study {

/// The processes that do a study together, started by mpirun or srun.
class BUTEE_EXPORT Team {
 public:
  virtual ~Team() = default;
  virtual int rank() const = 0;
  virtual int size() const = 0;
  /// Waits for all processes; returns the largest of their `status`.
  virtual int agree(int status) = 0;
  /// Adds to a shared number, initially 0, and returns its previous value. Thread-safe.
  virtual std::int64_t add(std::int64_t count) = 0;
  /// Allows add() of other processes to progress; to be called some times a second. Thread-safe.
  virtual void serve() = 0;
};

/// The team of this process, by the module study_mpi, which is opened only if mpirun or srun
/// started several processes; nullptr for a single process. Throws InputError if the module is
/// missing.
BUTEE_EXPORT std::unique_ptr<Team> join_team();

}  // namespace butee::study
