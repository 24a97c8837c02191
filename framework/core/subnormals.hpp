#pragma once

#include <cstdint>

#include <butee/export.hpp>

namespace butee {

/// During its lifetime this thread treats numbers below 2.2e-308 as zero, if the machine supports
/// it (x86-64, AArch64); the previous mode is then restored. Motion that decays along a large
/// structure passes through such numbers, on which arithmetic takes a hundred times as long: with a
/// load in the middle of 10 000 DOFs a step took five times as long.
class BUTEE_EXPORT FlushedSubnormals {
 public:
  FlushedSubnormals();
  ~FlushedSubnormals();
  FlushedSubnormals(const FlushedSubnormals&) = delete;
  FlushedSubnormals& operator=(const FlushedSubnormals&) = delete;

 private:
  std::uint64_t before_ = 0;  ///< the previous floating-point control register of this thread
};

}  // namespace butee
