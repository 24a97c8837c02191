#include "butee/config/value.hpp"

namespace butee::config {

Value& Table::operator[](std::string_view key) {
  if (Value* found = find(key)) return *found;
  return entries.emplace_back(std::string(key), Value{}).second;
}

const char* Value::kind() const {
  constexpr const char* kKinds[] = {"a boolean", "an integer", "a number", "a string", "an array", "a table"};
  return kKinds[data.index()];
}

std::string describe(const Document& document, Location at) {
  const std::string& source = document.sources.at(static_cast<std::size_t>(at.source));
  return at.line > 0 ? source + ":" + std::to_string(at.line) : source;
}

}  // namespace butee::config
