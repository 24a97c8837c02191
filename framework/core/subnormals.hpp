#pragma once

#include <cstdint>

#include <butee/export.hpp>

namespace butee {

/// While it lives, this thread takes numbers below 2.2e-308 for zero, where the machine can (x86-64, AArch64);
/// afterwards it computes as before. What decays along a large structure passes through such numbers, on which
/// arithmetic takes a hundred times as long: with a load in the middle of 10 000 DOFs a step took five times as long.
class BUTEE_EXPORT FlushedSubnormals {
 public:
  FlushedSubnormals();
  ~FlushedSubnormals();
  FlushedSubnormals(const FlushedSubnormals&) = delete;
  FlushedSubnormals& operator=(const FlushedSubnormals&) = delete;

 private:
  std::uint64_t before_ = 0;  ///< the register that says how this thread computes
};

}  // namespace butee
