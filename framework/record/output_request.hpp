#pragma once

#include <optional>
#include <string>
#include <vector>

#include "butee/record/field_request.hpp"

namespace butee::record {

struct ProbeRequest {
  std::string label;
  model::NodeId node = 0;
  std::vector<Quantity> quantities;
  std::string element{};  ///< "", or the beam or spring whose forces are recorded: see element_choice.hpp
};

/// What [output] asks for.
struct OutputRequest {
  std::optional<double> interval;  ///< s; rows at 0, interval, 2 interval, ..., end_time
  std::int64_t every = 0;          ///< rows at every so manyth accepted step, where interval is absent
  std::int64_t checkpoint = 0;     ///< a checkpoint after every so manyth accepted step; 0: none
  std::vector<double> states;      ///< s, ascending: of these instants the whole motion is kept, beside the last
  bool energy = false;
  bool impacts = false;
  bool trust = false;            ///< find out how far the answer can be trusted
  double trust_accuracy = 1e-2;  ///< relative to the peak
  std::vector<ProbeRequest> probes;
  bool csv = true;  ///< history.csv
  FieldRequest fields;
};

/// Reads [output]; without it 1000 equal intervals and a probe of u on every loaded node. Mistakes go to `diagnostics`.
/// `model` need not be complete where there were mistakes before. `formats` are those known beside csv.
BUTEE_EXPORT OutputRequest read_output(const config::Value& root, const model::Model& model, double end_time,
                                       config::Diagnostics& diagnostics,
                                       const std::vector<model::FieldFormat>& formats = {});

}  // namespace butee::record
