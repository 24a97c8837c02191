#include "scale.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <butee/core/text.hpp>

namespace butee::app::plot {
namespace {

struct Prefix {
  double value;
  const char* text;
};

constexpr std::array<Prefix, 6> kPrefixes = {
    {{1e6, "M"}, {1e3, "k"}, {1.0, ""}, {1e-3, "m"}, {1e-6, "µ"}, {1e-9, "n"}}};
/// Relative tolerance below a power of ten that still gets the larger prefix: 0.9999999 s is 1 s.
constexpr double kAlmost = 1.0 - 1e-6;

}  // namespace

Scale scale_for(double largest, const std::string& unit) {
  if (!(largest > 0.0) || unit.empty() || unit == "1") return {1.0, unit == "1" ? "" : unit};
  const bool takes_large = unit == "N" || unit == "J" || unit == "Hz" || unit == "N m" || unit == "Pa";
  for (const Prefix& prefix : kPrefixes)
    if (largest >= prefix.value * kAlmost && (prefix.value <= 1.0 || takes_large))
      return {1.0 / prefix.value, prefix.text + unit};
  return {1.0 / kPrefixes.back().value, kPrefixes.back().text + unit};
}

double largest_of(std::span<const double> values) {
  double largest = 0.0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  return largest;
}

std::string short_number(double value, int digits) {
  return to_short_text(value, digits);
}

}  // namespace butee::app::plot
