#include <csignal>

#include <butee/plugin/entry.hpp>

namespace {

/// Code that runs as soon as the module is opened, before anybody can ask what it is.
struct Crashes {
  Crashes() { std::raise(SIGSEGV); }
} crashes;

}  // namespace

BUTEE_PLUGIN(registrar) {
  (void)registrar;
}
