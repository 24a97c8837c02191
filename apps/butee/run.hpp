#pragma once

#include <butee/run/run.hpp>

#include "interruption.hpp"

namespace butee::app {

using run::check_checkpoints;

/// A run that SIGINT and SIGTERM stop after the current step.
class Run : public run::Run {
 public:
  Run(scene::Scene& session, bool with_progress) : run::Run(session, with_progress) { interrupt_by(interruption); }
};

}  // namespace butee::app
