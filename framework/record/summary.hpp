#pragma once

#include <map>
#include <optional>
#include <string>

#include "butee/record/energy.hpp"
#include "butee/record/trust.hpp"

namespace butee::record {

/// The content of summary.json.
struct Summary {
  time::RunReport report;
  std::string integrator;
  std::string choice;  ///< why `auto` chose the method; empty if the scene names the method
  linalg::Counters counters;
  double setup_seconds = 0.0;
  Index dofs = 0, contacts = 0;
  std::map<std::string, double> peaks;
  Energy energy;
  struct Followed {
    double work, dissipated, balance_error;
  };
  std::optional<Followed> followed;
  std::optional<Trust> trust;  ///< if requested
};

/// The summary as JSON; a number that is not finite becomes null.
BUTEE_EXPORT std::string to_json(const Summary& summary);
/// True if this is the text of a completed run's summary.
bool is_completed(const std::string& json);

}  // namespace butee::record
