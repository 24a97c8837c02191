#pragma once

#include <string>

#include <butee/export.hpp>

/// Messages to the user on standard error. The only interface to spdlog.
namespace butee::log {

enum class Level { quiet, normal, verbose };

/// quiet: warnings and errors only; normal: also information; verbose: also details.
BUTEE_EXPORT void set_level(Level level);
BUTEE_EXPORT bool is_quiet();

/// Suppresses warnings during its lifetime, for auxiliary runs such as those of a comparison.
class BUTEE_EXPORT WithoutWarnings {
 public:
  WithoutWarnings();
  ~WithoutWarnings();
  WithoutWarnings(const WithoutWarnings&) = delete;
  WithoutWarnings& operator=(const WithoutWarnings&) = delete;
};

BUTEE_EXPORT void debug(const std::string& message);
BUTEE_EXPORT void info(const std::string& message);
BUTEE_EXPORT void warning(const std::string& message);
BUTEE_EXPORT void error(const std::string& message);

}  // namespace butee::log
