#pragma once

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
};

/// The team of this process by the module study_mpi, which is opened only where mpirun or srun started several of them;
/// nullptr where this one is alone. Throws InputError where the module is missing.
BUTEE_EXPORT std::unique_ptr<Team> join_team();

}  // namespace butee::study
