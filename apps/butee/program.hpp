#pragma once

namespace butee::app {

/// Exit statuses of the program.
enum Exit : int { kDone = 0, kFailed = 1, kBadInput = 2 };

/// Parses the command line and runs the command. Throws what the commands throw.
int parse_and_run(int argc, char** argv);

}  // namespace butee::app
