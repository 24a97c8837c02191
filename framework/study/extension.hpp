#pragma once

#include <string>

#include <butee/export.hpp>

namespace butee::study {

/// Makes an object of an extension; its owner is the caller.
using Maker = void* (*)();

/// A function of a module that only studies use, in lib/butee/study beside the library; opened at the first call.
/// nullptr where the module is not installed. Throws RunError where it is of another butee.
BUTEE_EXPORT Maker find_extension(const std::string& module, const char* function);

}  // namespace butee::study
