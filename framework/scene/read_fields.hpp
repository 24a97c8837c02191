#pragma once

#include <string>
#include <vector>

#include "butee/config/parameters.hpp"
#include "butee/model/model.hpp"
#include "butee/model/output_request.hpp"

namespace butee::scene {

/// What [output] formats names.
struct FormatRequest {
  bool csv = true;                  ///< history.csv
  std::vector<std::string> fields;  ///< the formats of fields
};

/// Reads the key `formats`; `known` are those beside csv. Mistakes go to `diagnostics`. Private to the framework.
FormatRequest read_formats(const config::Parameters& output, const std::vector<std::string>& known,
                           config::Diagnostics& diagnostics);

/// Reads the key `fields`: all nodes and five quantities where it is absent. `model` may be null where it has mistakes
/// of its own. Private to the framework.
model::FieldRequest read_fields(const config::Parameters& output, std::vector<std::string> formats,
                                const model::Model* model, config::Diagnostics& diagnostics);

}  // namespace butee::scene
