#include "butee/config/diagnostics.hpp"

#include <algorithm>
#include <numeric>

#include "butee/config/scene_error.hpp"
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

/// The parts of a message composed by error(); `place` is the location of the error.
Mistake parts_of(const std::string& text, const std::string& place, const std::string& file, int line) {
  const std::string rest = text.substr(place.size() + 2);
  const std::size_t end = std::min(rest.find(" = "), rest.find(": "));
  return {file, line, rest.substr(0, end), rest.substr(end + (rest.compare(end, 3, " = ") == 0 ? 3 : 2))};
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
  std::vector<Mistake> mistakes;
  for (const std::size_t i : order) {
    const Location at = places_[i];
    const std::string& file = document_->sources[static_cast<std::size_t>(at.source)];
    mistakes.push_back(parts_of(errors_[i], describe(*document_, at), file, at.line));
    sorted.push_back(errors_[i]);
  }
  throw SceneError(join(sorted, "\n"), std::move(mistakes));
}

}  // namespace butee::config
