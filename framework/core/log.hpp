#pragma once

#include <string>

#include <butee/export.hpp>

/// Messages to people on standard error. The only door to spdlog.
namespace butee::log {

enum class Level { quiet, normal, verbose };

/// quiet: warnings and errors alone; normal: information too; verbose: details too.
BUTEE_EXPORT void set_level(Level level);
BUTEE_EXPORT bool is_quiet();

/// While one lives warnings are dropped: for runs whose warnings nobody asked for, such as the many of a comparison.
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
