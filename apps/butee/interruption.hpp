#pragma once

namespace butee::app {

/// From now on SIGINT and SIGTERM are noted, so that what is under way ends at the next step. The second one ends the
/// program at once.
void watch_for_interruption();

/// "SIGINT", "SIGTERM", or nullptr where there was none.
const char* interruption();

}  // namespace butee::app
