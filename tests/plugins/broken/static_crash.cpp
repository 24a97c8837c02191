#include <csignal>

#include <butee/plugin/entry.hpp>

namespace {

/// Crashes in static initialisation, as soon as the module is opened and before it can be queried.
struct Crashes {
  Crashes() { std::raise(SIGSEGV); }
} crashes;

}  // namespace

BUTEE_PLUGIN(registrar) {
  (void)registrar;
}
