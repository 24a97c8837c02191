#include "installation.hpp"

#include <filesystem>

#include <butee/core/error.hpp>

namespace butee::app {

namespace fs = std::filesystem;

namespace {

/// The folder that holds bin/, also for an installation that was moved.
fs::path prefix() {
  return fs::read_symlink("/proc/self/exe").parent_path().parent_path();
}

std::string existing(const fs::path& path) {
  if (!fs::exists(path)) throw RunError(path.string() + ": is missing; this butee is only partly installed or built");
  return path.string();
}

}  // namespace

std::string shared_folder(const std::string& name) {
  return existing(prefix() / "share" / "butee" / name);
}

std::string helper_program(const std::string& name) {
  return existing(prefix() / "libexec" / "butee" / name);
}

std::string package_prefix() {
  const std::string found = prefix().string();
  return found == "/usr" || found == "/usr/local" ? "" : found;
}

}  // namespace butee::app
