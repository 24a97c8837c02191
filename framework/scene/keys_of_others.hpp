#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "butee/config/diagnostics.hpp"
#include "butee/config/parameters.hpp"
#include "butee/core/text.hpp"

namespace butee::scene {

/// Reports the keys of an entry that its type lacks and others have, naming these, and adds them to `known`, the keys
/// that are no error or reported. `choice`: the key and type chosen, `law = "linear"`.
template <class Type>
void report_keys_of_others(const config::Value& entry, const std::string& path, const std::string& choice,
                           const std::vector<Type>& types, std::vector<std::string>& known,
                           config::Diagnostics& diagnostics) {
  const config::Table* table = entry.table();
  if (table == nullptr) return;
  for (const auto& [key, value] : table->entries) {
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    std::vector<std::string> owners;
    for (const Type& type : types)
      for (const std::string& name : config::names_of(type.parameters))
        if (name == key) owners.push_back(type.name);
    if (owners.empty()) continue;
    diagnostics.error(
        path + "." + key, value,
        "is no key of " + choice + "; it belongs to " + butee::join(owners) + ": remove it, or choose one of these");
    known.push_back(key);
  }
}

}  // namespace butee::scene
