#pragma once

#include <cstddef>
#include <vector>

namespace butee::app::plot {

/// Which points of a long curve a picture needs; all of them where they are few.
///
/// Of every stretch that is as narrow as the pen it takes the first, the lowest, the highest and the last point, so
/// that the picture is the one of all points.
std::vector<std::size_t> thin(const std::vector<double>& y);

/// The same for a curve in the plane: leaves out points that lie as near to the one before as the pen is wide.
std::vector<std::size_t> thin_path(const std::vector<double>& x, const std::vector<double>& y);

/// 0, 1, ..., count - 1
std::vector<std::size_t> every(std::size_t count);

}  // namespace butee::app::plot
