#include "butee/core/log.hpp"

#include <memory>

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include "butee/core/text.hpp"

namespace butee::log {
namespace {

spdlog::logger& logger() {
  static const std::shared_ptr<spdlog::logger> instance = [] {
    auto made = std::make_shared<spdlog::logger>("butee", std::make_shared<spdlog::sinks::stderr_color_sink_mt>());
    made->set_pattern("butee: %^%l%$: %v");
    return made;
  }();
  return *instance;
}

}  // namespace

void set_level(Level level) {
  switch (level) {
    case Level::quiet:
      return logger().set_level(spdlog::level::warn);
    case Level::normal:
      return logger().set_level(spdlog::level::info);
    case Level::verbose:
      return logger().set_level(spdlog::level::debug);
  }
}

bool is_quiet() {
  return logger().level() >= spdlog::level::warn;
}

void debug(const std::string& message) {
  logger().debug(printable(message, true));
}
void info(const std::string& message) {
  logger().info(printable(message, true));
}
void warning(const std::string& message) {
  logger().warn(printable(message, true));
}
void error(const std::string& message) {
  logger().error(printable(message, true));
}

}  // namespace butee::log
