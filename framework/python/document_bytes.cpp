#include "butee/python/document_bytes.hpp"

#include "butee/core/error.hpp"

namespace butee::python {
namespace {

constexpr int kDeepest = 1000;

void put(const config::Value& value, ByteWriter& to) {
  to.put(value.at.source);
  to.put(value.at.line);
  to.put(static_cast<std::uint8_t>(value.data.index()));
  if (const bool* flag = std::get_if<bool>(&value.data)) return to.put(*flag);
  if (const auto* integer = std::get_if<std::int64_t>(&value.data)) return to.put(*integer);
  if (const double* number = std::get_if<double>(&value.data)) return to.put(*number);
  if (const std::string* text = value.text()) return to.put(*text);
  if (const config::Array* array = value.array()) {
    to.put(static_cast<std::uint64_t>(array->size()));
    for (const config::Value& item : *array) put(item, to);
    return;
  }
  const auto& entries = value.table()->entries;
  to.put(static_cast<std::uint64_t>(entries.size()));
  for (const auto& [key, item] : entries) {
    to.put(key);
    put(item, to);
  }
}

config::Value take(ByteReader& from, std::int32_t sources, int depth) {
  config::Value value;
  from.take(value.at.source);
  from.take(value.at.line);
  const auto kind = from.take<std::uint8_t>();
  if (depth > kDeepest || kind > 5 || value.at.source < 0 || value.at.source >= sources)
    throw RunError("the bytes are not a scene");
  if (kind == 0) value.data = from.take<bool>();
  if (kind == 1) value.data = from.take<std::int64_t>();
  if (kind == 2) value.data = from.take<double>();
  if (kind == 3) value.data = from.take<std::string>();
  if (kind < 4) return value;
  const std::size_t count = from.count();
  if (kind == 4) {
    config::Array array;
    for (std::size_t i = 0; i < count; ++i) array.push_back(take(from, sources, depth + 1));
    value.data = std::move(array);
    return value;
  }
  config::Table table;
  for (std::size_t i = 0; i < count; ++i) {
    auto key = from.take<std::string>();
    table.entries.emplace_back(std::move(key), take(from, sources, depth + 1));
  }
  value.data = std::move(table);
  return value;
}

template <class Visit>
void visit(config::Value& value, const Visit& each) {
  each(value.at.source);
  if (config::Array* array = value.array())
    for (config::Value& item : *array) visit(item, each);
  if (config::Table* table = value.table())
    for (auto& entry : table->entries) visit(entry.second, each);
}

}  // namespace

std::vector<std::byte> to_bytes(const config::Document& document) {
  std::vector<std::byte> bytes;
  ByteWriter to(bytes);
  to.put(static_cast<std::uint64_t>(document.sources.size()));
  for (const std::string& source : document.sources) to.put(source);
  put(document.root, to);
  return bytes;
}

config::Document to_document(std::span<const std::byte> bytes) {
  ByteReader from(bytes);
  config::Document document;
  for (std::size_t count = from.count(); count > 0; --count) document.sources.push_back(from.take<std::string>());
  document.root = take(from, static_cast<std::int32_t>(document.sources.size()), 0);
  if (document.root.table() == nullptr || !from.at_end()) throw RunError("the bytes are not a scene");
  return document;
}

void drop_unused_sources(config::Document& document) {
  std::vector<std::int32_t> places(document.sources.size(), -1);
  places[0] = 0;
  visit(document.root, [&](std::int32_t source) { places[static_cast<std::size_t>(source)] = 0; });
  std::vector<std::string> kept;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (places[i] < 0) continue;
    places[i] = static_cast<std::int32_t>(kept.size());
    kept.push_back(std::move(document.sources[i]));
  }
  document.sources = std::move(kept);
  visit(document.root, [&](std::int32_t& source) { source = places[static_cast<std::size_t>(source)]; });
}

}  // namespace butee::python
