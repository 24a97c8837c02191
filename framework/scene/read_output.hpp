#pragma once

#include <vector>

#include "butee/config/diagnostics.hpp"
#include "butee/model/field_format.hpp"
#include "butee/model/model.hpp"
#include "butee/model/output_request.hpp"

namespace butee::scene {

/// Reads [output]; without it 1000 equal intervals and a probe of u on every loaded node. Errors go
/// to `diagnostics`. `model` may be incomplete after earlier errors. `formats` are the known
/// formats other than csv.
BUTEE_EXPORT model::OutputRequest read_output(const config::Value& root, const model::Model& model, double end_time,
                                              config::Diagnostics& diagnostics,
                                              const std::vector<model::FieldFormat>& formats = {});

}  // namespace butee::scene
