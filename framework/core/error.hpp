#pragma once

#include <stdexcept>
#include <string>

#include <butee/export.hpp>

namespace butee {

/// Bad input: the message states the location, the given value, the violated constraint and the
/// remedy. It may hold several lines, one for each error.
class BUTEE_EXPORT InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A failure outside the numerics: a file that cannot be written, a module that fails.
class BUTEE_EXPORT RunError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A broken invariant: an error in the calling code, never in a scene.
class BUTEE_EXPORT LogicError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

/// Throws LogicError with `message` unless `condition` holds.
inline void require(bool condition, const char* message) {
  if (!condition) throw LogicError(message);
}

}  // namespace butee
