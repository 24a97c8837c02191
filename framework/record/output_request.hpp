#pragma once

#include <optional>
#include <string>
#include <vector>

#include "butee/config/diagnostics.hpp"
#include "butee/model/model.hpp"

namespace butee::record {

/// What a probe can record of its node.
enum class Quantity { u, v, a, theta, theta_v, theta_a, contact_force };

BUTEE_EXPORT const char* name_of(Quantity quantity);

struct ProbeRequest {
  std::string label;
  model::NodeId node = 0;
  std::vector<Quantity> quantities;
};

/// What [output] asks for.
struct OutputRequest {
  std::optional<double> interval;  ///< s; rows at 0, interval, 2 interval, ..., end_time
  std::int64_t every = 0;          ///< rows at every so manyth accepted step, where interval is absent
  std::int64_t checkpoint = 0;     ///< a checkpoint after every so manyth accepted step; 0: none
  bool energy = false;
  bool impacts = false;
  bool trust = false;            ///< find out how far the answer can be trusted
  double trust_accuracy = 1e-2;  ///< relative to the peak
  std::vector<ProbeRequest> probes;
};

/// Reads [output]; without it 1000 equal intervals and a probe of u on every loaded node. Mistakes go to `diagnostics`.
/// `model` need not be complete where there were mistakes before.
BUTEE_EXPORT OutputRequest read_output(const config::Value& root, const model::Model& model, double end_time,
                                       config::Diagnostics& diagnostics);

}  // namespace butee::record
