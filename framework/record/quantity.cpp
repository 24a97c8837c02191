#include "butee/record/quantity.hpp"

#include <algorithm>
#include <array>

#include "butee/core/error.hpp"

namespace butee::record {
namespace {

constexpr std::array<const char*, 8> kNames = {"u",         "v", "a", "theta", "theta_v", "theta_a", "contact_force",
                                               "stop_state"};
constexpr std::array<const char*, 8> kUnits = {"m", "m/s", "m/s2", "rad", "rad/s", "rad/s2", "N", "1"};

}  // namespace

const char* name_of(Quantity quantity) {
  return kNames.at(static_cast<std::size_t>(quantity));
}

const char* unit_of(Quantity quantity) {
  return kUnits.at(static_cast<std::size_t>(quantity));
}

Quantity quantity_of(const std::string& name) {
  const auto* const found = std::find(kNames.begin(), kNames.end(), name);
  require(found != kNames.end(), "no such quantity");
  return static_cast<Quantity>(found - kNames.begin());
}

std::vector<std::string> all_quantities() {
  return {kNames.begin(), kNames.end()};
}

std::vector<std::string> probe_quantities() {
  return {kNames.begin(), kNames.end() - 1};
}

}  // namespace butee::record
