// For the sources of this folder and of dynamics/kernel, included after <hwy/highway.h> in each
// pass. Highway's own tables and library are not used: loading the library measures a clock for 4
// ms.
#ifndef BUTEE_KERNEL
#include "butee/core/target.hpp"
/// The versions of a function, in the order of target_index().
#define BUTEE_KERNELS(function)                                                                                        \
  static decltype(&HWY_STATIC_DISPATCH(function))                                                                      \
      const function##_versions[] = {HWY_CHOOSE_AVX3(function), HWY_CHOOSE_AVX2(function), HWY_CHOOSE_SSSE3(function), \
                                     HWY_CHOOSE_NEON(function), HWY_CHOOSE_FALLBACK(function)}
/// The version for the chosen instruction set.
#define BUTEE_KERNEL(function) (*function##_versions[target_index()])
#endif
