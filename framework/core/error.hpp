#pragma once

#include <stdexcept>
#include <string>

#include <butee/export.hpp>

namespace butee {

/// Bad input: the message says where, what was given, which constraint it breaks and what to do.
/// It may hold several lines, one for each mistake found.
class BUTEE_EXPORT InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Work that failed outside the numerics: a file that cannot be written, a module that breaks.
class BUTEE_EXPORT RunError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A broken invariant: a bug in the calling code, never the fault of a scene.
class BUTEE_EXPORT LogicError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

/// Throws LogicError with `message` unless `condition` holds.
inline void require(bool condition, const char* message) {
  if (!condition) throw LogicError(message);
}

}  // namespace butee
