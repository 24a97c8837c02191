#include "butee/config/model_builder.hpp"

#include <algorithm>

#include "butee/config/toml.hpp"
#include "butee/core/error.hpp"

namespace butee::config {
namespace {

template <class List>
Value list_of(const List& list) {
  Array array;
  for (const auto& item : list) array.push_back(Setting(item).value());
  return {std::move(array)};
}

Value table_of(const Keys& keys, Location at) {
  Table table;
  for (const Key& key : keys) {
    table[key.name] = key.value.value();
    table[key.name].at = at;
  }
  return {std::move(table), at};
}

}  // namespace

Setting::Setting(std::initializer_list<Setting> list) : value_(list_of(list)) {}
Setting::Setting(const std::vector<double>& list) : value_(list_of(list)) {}
Setting::Setting(const std::vector<std::string>& list) : value_(list_of(list)) {}
Setting::Setting(const Keys& table) : value_(table_of(table, {})) {}

ModelBuilder::ModelBuilder() {
  document_.sources = {"model in code"};
  (*document_.root.table())["schema"] = Value(std::int64_t{1});
}

void ModelBuilder::refuse(const std::string& problem) const {
  throw LogicError(document_.sources.front() + ":" + std::to_string(calls_) + ": " + problem);
}

Value& ModelBuilder::table_at(const std::string& path) {
  Value* value = &document_.root;
  for (std::size_t begin = 0; begin <= path.size();) {
    const std::size_t dot = std::min(path.find('.', begin), path.size());
    value = &(*value->table())[path.substr(begin, dot - begin)];
    if (value->table() == nullptr) refuse(path + ": " + path.substr(0, dot) + " is not a table, but " + value->kind());
    begin = dot + 1;
  }
  return *value;
}

ModelBuilder& ModelBuilder::set(const std::string& table, const Keys& keys) {
  const Location at{0, ++calls_};
  Value& value = table_at(table);
  value.at = at;
  for (const Key& key : keys) {
    (*value.table())[key.name] = key.value.value();
    (*value.table())[key.name].at = at;
  }
  return *this;
}

ModelBuilder& ModelBuilder::add(const std::string& list, const Keys& keys) {
  const Location at{0, ++calls_};
  Value& value = (*document_.root.table())[list];
  if (value.array() == nullptr) {
    if (value.table() == nullptr || !value.table()->entries.empty())
      refuse(list + " is not a list, but " + value.kind() + "; set() gives keys to a table");
    value = Value(Array{}, at);
  }
  value.array()->push_back(table_of(keys, at));
  return *this;
}

std::string ModelBuilder::toml() const {
  return write_toml(*document_.root.table());
}

}  // namespace butee::config
