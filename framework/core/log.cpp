#include "butee/core/log.hpp"

#include <memory>

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

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
  logger().debug(message);
}
void info(const std::string& message) {
  logger().info(message);
}
void warning(const std::string& message) {
  logger().warn(message);
}
void error(const std::string& message) {
  logger().error(message);
}

}  // namespace butee::log
