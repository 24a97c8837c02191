#pragma once

#include <string>

#include <butee/export.hpp>

namespace butee {

/// A string formatted by the rules of printf.
[[gnu::format(printf, 1, 2)]] BUTEE_EXPORT std::string formatted(const char* pattern, ...);

}  // namespace butee
