#include "butee/config/diagnostics.hpp"

#include <algorithm>
#include <numeric>

#include "butee/config/toml.hpp"
#include "butee/core/error.hpp"
#include "butee/core/text.hpp"

namespace butee::config {
namespace {

std::string abbreviated(const Value& value) {
  constexpr std::size_t kLongest = 60;
  const std::string text = to_toml(value);
  return text.size() <= kLongest ? text : text.substr(0, kLongest) + "...";
}

}  // namespace

void Diagnostics::error(const std::string& key, const Value& value, const std::string& complaint) {
  error(key + " = " + abbreviated(value), value.at, complaint);
}

void Diagnostics::error(const std::string& key, Location at, const std::string& complaint) {
  errors_.push_back(describe(*document_, at) + ": " + key + ": " + complaint);
  places_.push_back(at);
}

void Diagnostics::warning(const std::string& key, Location at, const std::string& complaint) {
  warnings_.push_back(describe(*document_, at) + ": " + key + ": " + complaint);
}

void Diagnostics::throw_if_any() const {
  if (errors_.empty()) return;
  std::vector<std::size_t> order(errors_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [this](std::size_t a, std::size_t b) {
    const Location &p = places_[a], &q = places_[b];
    return p.source != q.source ? p.source < q.source : p.line < q.line;
  });
  std::vector<std::string> sorted;
  for (const std::size_t i : order) sorted.push_back(errors_[i]);
  throw InputError(join(sorted, "\n"));
}

}  // namespace butee::config
