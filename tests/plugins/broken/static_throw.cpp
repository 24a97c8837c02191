#include <stdexcept>

#include <butee/plugin/entry.hpp>

namespace {

struct Throws {
  Throws() { throw std::runtime_error("no door yet"); }
} throws;

}  // namespace

BUTEE_PLUGIN(registrar) {
  (void)registrar;
}
