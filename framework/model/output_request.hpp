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

/// Fields: quantities of many nodes, for the field formats.
struct FieldRequest {
  std::vector<std::string> formats;  ///< empty: no fields
  std::vector<NodeId> nodes;         ///< ascending
  std::vector<Quantity> quantities;
  std::optional<double> interval;  ///< s; that of the rows if absent
};

/// The requests of [output].
struct OutputRequest {
  std::optional<double> interval;  ///< s; rows at 0, interval, 2 interval, ..., end_time
  std::int64_t every = 0;          ///< rows at every `every`-th accepted step, if interval is absent
  std::int64_t checkpoint = 0;     ///< a checkpoint after every `checkpoint`-th accepted step; 0: none
  std::vector<double> states;      ///< s, ascending: instants at which the whole motion is saved, in addition to the
                                   ///< last one
  bool energy = false;
  bool impacts = false;
  bool trust = false;            ///< estimate how far the result can be trusted
  double trust_accuracy = 1e-2;  ///< relative to the peak
  std::vector<ProbeRequest> probes;
  bool csv = true;  ///< history.csv
  FieldRequest fields;
};

}  // namespace butee::model
