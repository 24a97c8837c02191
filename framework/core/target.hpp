#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <butee/export.hpp>

namespace butee {

/// The instruction set of the kernels (linalg/kernel, dynamics/kernel): "avx512", "avx2", "ssse3" or "sse2"; "neon" or
/// "generic" on other processors. The best that the processor has, or the one that the environment variable
/// BUTEE_TARGET names; fixed at its first use. Results of different sets differ in their last digits. Throws InputError
/// where BUTEE_TARGET names none of targets().
BUTEE_EXPORT const std::string& target();

/// What all the rest of the library is compiled for: "x86-64-v4", "x86-64-v3", "x86-64-v2", "x86-64" or "other".
BUTEE_EXPORT std::string compiled_for();

/// Those of this library that the processor has, the best first.
BUTEE_EXPORT std::vector<std::string> targets();

/// For tests: takes another of targets() for what is constructed from now on.
BUTEE_EXPORT void choose_target(const std::string& name);

/// Where a kernel of the chosen set is in the tables. For the kernels, not exported.
std::size_t target_index();

}  // namespace butee
