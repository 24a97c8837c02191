#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <butee/export.hpp>

namespace butee {

/// The instruction set of the kernels (linalg/kernel, dynamics/kernel): "avx512", "avx2", "ssse3"
/// or "sse2"; "neon" or "generic" on other processors. The best that the processor has, or the one
/// that the environment variable BUTEE_TARGET names; fixed at its first use. Results of different
/// sets differ in their last digits. Throws InputError if BUTEE_TARGET is not one of targets().
BUTEE_EXPORT const std::string& target();

/// The target of the rest of the library: "x86-64-v4", "x86-64-v3", "x86-64-v2", "x86-64" or
/// "other".
BUTEE_EXPORT std::string compiled_for();

/// The instruction sets in this library that the processor supports, best first.
BUTEE_EXPORT std::vector<std::string> targets();

/// For tests: selects another of targets() for objects constructed from now on.
BUTEE_EXPORT void choose_target(const std::string& name);

/// The index of the chosen set in the tables of kernels. For the kernels, not exported.
std::size_t target_index();

}  // namespace butee
