// For the sources of this folder, included behind <hwy/highway.h> in each pass.
#ifndef BUTEE_KERNEL
#include "butee/core/target.hpp"
/// The version of an HWY_EXPORTed function for the chosen instruction set.
#define BUTEE_KERNEL(function) (*HWY_DISPATCH_TABLE(function)[target_index()])
#endif
