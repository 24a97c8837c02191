#pragma once

#include <cstddef>
#include <vector>

namespace butee::app::plot {

/// Indices of the points of a long curve that a picture needs; all points if they are few.
///
/// From each interval as narrow as the pen it takes the first, lowest, highest and last point; the picture is
/// the same as with all points.
std::vector<std::size_t> thin(const std::vector<double>& y);

/// As above for a curve in the plane: skips points closer to the previous point than the pen width.
std::vector<std::size_t> thin_path(const std::vector<double>& x, const std::vector<double>& y);

/// 0, 1, ..., count - 1
std::vector<std::size_t> every(std::size_t count);

}  // namespace butee::app::plot
