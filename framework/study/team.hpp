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
  /// Waits for all; the largest of what they say.
  virtual int agree(int status) = 0;
  /// Adds to a number that all share, 0 at first; what it was before. For any thread.
  virtual std::int64_t add(std::int64_t count) = 0;
  /// Lets add() of other processes go on, which may need it some times a second. For any thread.
  virtual void serve() = 0;
};

/// The team of this process by the module study_mpi, which is opened only where mpirun or srun started several of them;
/// nullptr where this one is alone. Throws InputError where the module is missing.
BUTEE_EXPORT std::unique_ptr<Team> join_team();

}  // namespace butee::study
