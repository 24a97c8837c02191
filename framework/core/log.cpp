#include "butee/core/log.hpp"

#include <atomic>
#include <cstdio>
#include <memory>

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include "butee/core/terminal.hpp"
#include "butee/core/text.hpp"

namespace butee::log {
namespace {

spdlog::logger& logger() {
  static const std::shared_ptr<spdlog::logger> instance = [] {
    const auto colours = takes_colour(stderr) ? spdlog::color_mode::automatic : spdlog::color_mode::never;
    auto made =
        std::make_shared<spdlog::logger>("butee", std::make_shared<spdlog::sinks::stderr_color_sink_mt>(colours));
    made->set_pattern("butee: %^%l%$: %v");
    return made;
  }();
  return *instance;
}

std::atomic<int> muted = 0;

}  // namespace

WithoutWarnings::WithoutWarnings() {
  ++muted;
}

WithoutWarnings::~WithoutWarnings() {
  --muted;
}

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
  if (muted == 0) logger().warn(printable(message, true));
}
void error(const std::string& message) {
  logger().error(printable(message, true));
}

}  // namespace butee::log
