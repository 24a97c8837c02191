#pragma once

#include <optional>
#include <string>
#include <vector>

#include "butee/config/parameters.hpp"
#include "butee/model/field_format.hpp"
#include "butee/model/model.hpp"
#include "butee/record/quantity.hpp"

namespace butee::record {

/// Fields: quantities of many nodes, for the formats that keep them.
struct FieldRequest {
  std::vector<std::string> formats;  ///< none: no fields
  std::vector<model::NodeId> nodes;  ///< ascending
  std::vector<Quantity> quantities;
  std::optional<double> interval;  ///< s; as the rows where it is absent
};

/// What [output] formats names.
struct FormatRequest {
  bool csv = true;                  ///< history.csv
  std::vector<std::string> fields;  ///< the formats of fields
};

/// Reads the key `formats`; `known` are those beside csv. Mistakes go to `diagnostics`.
BUTEE_EXPORT FormatRequest read_formats(const config::Parameters& output, const std::vector<std::string>& known,
                                        config::Diagnostics& diagnostics);

/// Reads the key `fields`: all nodes and five quantities where it is absent. `model` may be null where it has mistakes
/// of its own.
BUTEE_EXPORT FieldRequest read_fields(const config::Parameters& output, std::vector<std::string> formats,
                                      const model::Model* model, config::Diagnostics& diagnostics);

}  // namespace butee::record
