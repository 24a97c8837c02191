#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "butee/model/nodes.hpp"
#include "butee/model/quantity.hpp"

namespace butee::model {

struct ProbeRequest {
  std::string label;
  NodeId node = 0;
  std::vector<Quantity> quantities;
  std::string element{};  ///< "", or the beam or spring whose forces are recorded: see element_choice.hpp
};

/// Fields: quantities of many nodes, for the formats that keep them.
struct FieldRequest {
  std::vector<std::string> formats;  ///< none: no fields
  std::vector<NodeId> nodes;         ///< ascending
  std::vector<Quantity> quantities;
  std::optional<double> interval;  ///< s; as the rows where it is absent
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

}  // namespace butee::model
