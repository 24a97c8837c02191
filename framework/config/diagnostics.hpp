#pragma once

#include <string>
#include <vector>

#include "butee/config/value.hpp"

namespace butee::config {

/// Collects all errors of a scene file, so that the user sees them together.
///
/// A message reads `FILE:LINE: KEY = VALUE: what is wrong and what is allowed`.
class BUTEE_EXPORT Diagnostics {
 public:
  explicit Diagnostics(const Document& document) : document_(&document) {}

  /// Reports an error in the value of `key`.
  void error(const std::string& key, const Value& value, const std::string& complaint);
  /// Reports an error about `key` as a whole, such as its absence from the table at `at`.
  void error(const std::string& key, Location at, const std::string& complaint);
  void warning(const std::string& key, Location at, const std::string& complaint);

  std::size_t error_count() const { return errors_.size(); }
  const std::vector<std::string>& errors() const { return errors_; }
  const std::vector<std::string>& warnings() const { return warnings_; }
  const Document& document() const { return *document_; }

  /// If there are errors, throws InputError with all messages, one per line, in the order of the
  /// file.
  void throw_if_any() const;

 private:
  const Document* document_;
  std::vector<std::string> errors_, warnings_;
  std::vector<Location> places_;
};

}  // namespace butee::config
