#include "thin.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace butee::app::plot {
namespace {

constexpr std::size_t kStretches = 800;  ///< intervals across the picture's width
constexpr double kPen = 1e-3;            ///< pen width as a fraction of the picture's width

}  // namespace

std::vector<std::size_t> every(std::size_t count) {
  std::vector<std::size_t> all(count);
  std::iota(all.begin(), all.end(), std::size_t{0});
  return all;
}

std::vector<std::size_t> thin(const std::vector<double>& y) {
  if (y.size() <= 4 * kStretches) return every(y.size());
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < kStretches; ++i) {
    const std::size_t begin = i * y.size() / kStretches, end = (i + 1) * y.size() / kStretches;
    const auto at = [&](auto place) { return static_cast<std::size_t>(place - y.begin()); };
    const auto first = y.begin() + static_cast<std::ptrdiff_t>(begin),
               last = y.begin() + static_cast<std::ptrdiff_t>(end);
    const auto [low, high] = std::minmax_element(first, last);
    std::vector<std::size_t> four = {begin, at(low), at(high), end - 1};
    std::sort(four.begin(), four.end());
    four.erase(std::unique(four.begin(), four.end()), four.end());
    kept.insert(kept.end(), four.begin(), four.end());
  }
  return kept;
}

std::vector<std::size_t> thin_path(const std::vector<double>& x, const std::vector<double>& y) {
  if (x.size() <= 4 * kStretches) return every(x.size());
  const auto [left, right] = std::minmax_element(x.begin(), x.end());
  const auto [low, high] = std::minmax_element(y.begin(), y.end());
  const double dx = kPen * (*right - *left), dy = kPen * (*high - *low);
  std::vector<std::size_t> kept = {0};
  for (std::size_t i = 1; i < x.size(); ++i) {
    const std::size_t last = kept.back();
    if (i + 1 == x.size() || std::abs(x[i] - x[last]) > dx || std::abs(y[i] - y[last]) > dy) kept.push_back(i);
  }
  return kept;
}

}  // namespace butee::app::plot
