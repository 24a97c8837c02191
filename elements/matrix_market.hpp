#pragma once

#include <string>
#include <string_view>

#include "butee/core/types.hpp"

namespace butee::elements {

/// The real square matrix in a Matrix Market text (NIST, https://math.nist.gov/MatrixMarket/formats.html): coordinate
/// or array format, real or integer entries, of general, symmetric or skew-symmetric structure; the triangle that the
/// last two leave out is filled in. Throws InputError ":17: what is wrong there" with the line.
///
/// Stricter than Eigen's MarketIO, which leaves the other triangle out and takes what is no number for zero: every line
/// is checked, entries come once, and their count is that of the header. Checked in tests/unit/matrix_market_test.cpp.
SparseMatrix read_matrix_market(std::string_view text);

}  // namespace butee::elements
