#pragma once

namespace butee::benchmarks {

/// Names are kernel/WHAT/SIDE and method/CASE/METHOD/SIDE, with the sides butee and plain, so that
/// ratio_table.cpp can pair them.
void register_kernels();
void register_methods();
/// scale/SCENE/DOFs/METHOD
void register_scale();

}  // namespace butee::benchmarks
