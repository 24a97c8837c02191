#pragma once

#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "butee/config/diagnostics.hpp"
#include "butee/config/value.hpp"

namespace butee::config {

/// The declaration of one key: allowed values, unit and meaning.
///
/// A declaration is plain data: it validates a scene and fills `butee plugins NAME`, the manifests
/// and the tables of the documents. It is written once, by the type that reads the key:
///
///     number("gap", "m", "free play on each side").at_least(0)
///     number("beta", "1", "Newmark's beta").or_else(0.25)
struct BUTEE_EXPORT Parameter {
  enum class Kind { number, integer, boolean, text, numbers, texts, table, matrix };

  Parameter at_least(double bound) const;
  Parameter above(double bound) const;
  Parameter at_most(double bound) const;
  /// The default; without one a key is required.
  Parameter or_else(Value::Data value) const;
  /// The key may be absent and then has no value.
  Parameter optional() const;
  /// The value to try first if a value is required; comparisons of methods start from it.
  Parameter try_first(Value::Data value) const;
  /// The key controls the accuracy of a method: comparisons vary it from `loose` to `tight`.
  Parameter sweep(double loose, double tight) const;
  /// The only texts allowed; for a number, texts allowed in its place.
  Parameter one_of(std::vector<std::string> names) const;
  /// The exact length of an array.
  Parameter of_length(std::size_t length) const;

  /// "number >= 0, m", for tables and messages.
  std::string describe() const;
  /// The reason why `value` is not allowed, or "".
  std::string complaint(const Value& value) const;

  std::string name;
  Kind kind = Kind::number;
  std::string unit;
  std::string help;
  bool required = true;
  std::optional<Value> fallback;
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  bool lower_open = false;
  std::vector<std::string> choices;
  std::optional<std::size_t> length;   ///< of an array, or number of rows of a matrix
  std::optional<std::size_t> columns;  ///< of a matrix
  std::optional<Value> first_try;
  std::optional<std::pair<double, double>> swept;  ///< from loose to tight
};

/// A finite real number; integers are accepted.
BUTEE_EXPORT Parameter number(std::string name, std::string unit, std::string help);
BUTEE_EXPORT Parameter integer(std::string name, std::string help);
BUTEE_EXPORT Parameter boolean(std::string name, std::string help);
BUTEE_EXPORT Parameter text(std::string name, std::string help);
/// An array of finite real numbers.
BUTEE_EXPORT Parameter numbers(std::string name, std::string unit, std::string help);
/// `rows` arrays of `columns` finite real numbers each.
BUTEE_EXPORT Parameter matrix(std::string name, std::string unit, std::string help, std::size_t rows,
                              std::size_t columns);
/// An array of strings; a single string stands for an array of one.
BUTEE_EXPORT Parameter texts(std::string name, std::string help);
/// A table or an array of tables, whose content its owner reads.
BUTEE_EXPORT Parameter table(std::string name, std::string help);

BUTEE_EXPORT std::vector<std::string> names_of(const std::vector<Parameter>& parameters);

}  // namespace butee::config
