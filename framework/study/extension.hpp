#pragma once

#include <string>

#include <butee/export.hpp>

namespace butee::study {

/// Makes an object of an extension; the caller owns it.
using Maker = void* (*)();

/// A function of a module that only studies use, in lib/butee/study beside the library; opened at
/// the first call. nullptr if the module is not installed. Throws RunError if it belongs to another
/// version of butee.
BUTEE_EXPORT Maker find_extension(const std::string& module, const char* function);

}  // namespace butee::study
