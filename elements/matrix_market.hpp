#pragma once

#include <string>
#include <string_view>

#include "butee/core/types.hpp"

namespace butee::elements {

/// The real square matrix in a Matrix Market text (NIST,
/// https://math.nist.gov/MatrixMarket/formats.html): coordinate or array format, real or integer
/// entries, general, symmetric or skew-symmetric structure; the triangle omitted by the last two is
/// filled in. Throws InputError ":17: what is wrong there" with the line.
///
/// Stricter than Eigen's MarketIO, which omits the other triangle and reads an invalid number as
/// zero: every line is checked, an entry other than 0 must not occur twice, and the number of entries must be
/// that of the header. Checked in tests/unit/matrix_market_test.cpp.
SparseMatrix read_matrix_market(std::string_view text);

}  // namespace butee::elements
