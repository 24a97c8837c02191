#pragma once

#include <string>
#include <vector>

#include "butee/config/parameters.hpp"
#include "butee/model/model.hpp"
#include "butee/model/output_request.hpp"

namespace butee::scene {

/// The content of [output] formats.
struct FormatRequest {
  bool csv = true;                  ///< history.csv
  std::vector<std::string> fields;  ///< the formats of fields
};

/// Reads the key `formats`; `known` are the formats other than csv. Errors go to `diagnostics`.
/// Private to the framework.
FormatRequest read_formats(const config::Parameters& output, const std::vector<std::string>& known,
                           config::Diagnostics& diagnostics);

/// Reads the key `fields`; by default all nodes and five quantities. `model` may be null if it has
/// errors. Private to the framework.
model::FieldRequest read_fields(const config::Parameters& output, std::vector<std::string> formats,
                                const model::Model* model, config::Diagnostics& diagnostics);

}  // namespace butee::scene
