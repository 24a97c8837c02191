#pragma once

#include <initializer_list>
#include <string>
#include <vector>

#include "butee/config/value.hpp"

namespace butee::config {

struct Key;
using Keys = std::vector<Key>;

/// The value of a key: text, a number, true or false, a list of these, or a table (Keys).
class BUTEE_EXPORT Setting {
 public:
  Setting(bool value) : value_(Value::Data(value)) {}
  Setting(int value) : value_(Value::Data(std::int64_t{value})) {}
  Setting(std::int64_t value) : value_(Value::Data(value)) {}
  Setting(double value) : value_(Value::Data(value)) {}
  Setting(const char* value) : value_(Value::Data(std::string(value))) {}
  Setting(std::string value) : value_(Value::Data(std::move(value))) {}
  Setting(std::initializer_list<Setting> list);
  Setting(const std::vector<double>& list);
  Setting(const std::vector<std::string>& list);
  Setting(const Keys& table);

  const Value& value() const { return value_; }

 private:
  Value value_;
};

struct Key {
  std::string name;
  Setting value;
};

/// A model built in code instead of read from a file, with the same tables and keys:
///
///     ModelBuilder model;
///     model.set("material.steel", {{"young_modulus", 2.1e11}, {"density", 7850.0}});
///     model.add("element", {{"type", "mass"}, {"name", "rotor"}, {"mass", 100.0}});
///     model.add("support", {{"nodes", {"string:first", "string:last"}}, {"fix", {"u"}}});
///     model.set("integrator", {{"tolerance", 1e-4}, {"end_time", 0.2}});
///     auto structure = embed::Structure::from_document(model.document());
///
/// Errors are reported when the model is used, as for a file; the number after the colon is that of
/// the call: "model in code:3: contact.gap = -1: ...".
class BUTEE_EXPORT ModelBuilder {
 public:
  ModelBuilder();

  /// Sets keys of a table, "integrator" or "material.steel". A missing table is created; an
  /// existing key is replaced. Throws LogicError with the number of the call if part of the path is a list or a number.
  ModelBuilder& set(const std::string& table, const Keys& keys);
  /// Appends to a list of tables: "element", "support", "contact", "load".
  ModelBuilder& add(const std::string& list, const Keys& keys);

  /// For Structure::from_document() and scene::read_scene().
  const Document& document() const { return document_; }
  /// The model as the text of a scene file for the program.
  std::string toml() const;

 private:
  Value& table_at(const std::string& path);
  [[noreturn]] void refuse(const std::string& problem) const;

  Document document_;
  std::int32_t calls_ = 0;
};

}  // namespace butee::config
