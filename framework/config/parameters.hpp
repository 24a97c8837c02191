#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "butee/config/parameter.hpp"
#include "butee/core/types.hpp"

namespace butee::config {

/// The validated values of a table: every key is declared, has a value or default, and is of its
/// declared kind.
///
/// The reading functions throw LogicError for a name that is not declared or has no value.
class BUTEE_EXPORT Parameters {
 public:
  /// False if an optional key is absent.
  bool has(std::string_view name) const;
  /// True if the file (or an override) gave the key; false for a default.
  bool given(std::string_view name) const;

  double number(std::string_view name) const;
  Index integer(std::string_view name) const;
  bool flag(std::string_view name) const;
  const std::string& text(std::string_view name) const;
  std::vector<double> numbers(std::string_view name) const;
  Eigen::MatrixXd matrix(std::string_view name) const;
  std::vector<std::string> texts(std::string_view name) const;
  const Value& value(std::string_view name) const;

  /// "contact[0].gap", the full key for messages.
  std::string key(std::string_view name) const;
  /// The table's own key ("contact[0]") and location.
  const std::string& path() const { return path_; }
  Location at() const { return at_; }

  /// Reports an error in the value of `name`, or its absence.
  void complain(Diagnostics& diagnostics, std::string_view name, const std::string& complaint) const;

  void set(const std::string& name, Value value, bool from_file);
  void place(std::string path, Location at);

 private:
  struct Entry {
    Value value;
    bool from_file;
  };
  std::map<std::string, Entry, std::less<>> entries_;
  std::string path_;
  Location at_;
};

/// The number in an integer or a number, else nothing.
BUTEE_EXPORT std::optional<double> as_number(const Value& value);

/// Checks a table against its declarations: unknown and missing keys, kinds, bounds. Every error
/// goes to `diagnostics`; if there are any, nothing is returned. Keys in `ignored` are read
/// elsewhere.
BUTEE_EXPORT std::optional<Parameters> read_parameters(const Value& table, const std::string& path,
                                                       const std::vector<Parameter>& declared, Diagnostics& diagnostics,
                                                       const std::vector<std::string>& ignored = {});

/// Defaults together with `given`; throws InputError if a required key is missing from `given`. For
/// models built in code.
BUTEE_EXPORT Parameters make_parameters(const std::vector<Parameter>& declared, const Table& given = {});

}  // namespace butee::config
