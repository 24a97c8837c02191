#pragma once

namespace butee::app {

/// From now on SIGINT and SIGTERM are recorded, and the current run ends at the next step. A signal more
/// than half a second later ends the program at once.
void watch_for_interruption();

/// "SIGINT", "SIGTERM", or nullptr if there was no signal.
const char* interruption();

}  // namespace butee::app
