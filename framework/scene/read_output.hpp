#pragma once

#include <vector>

#include "butee/config/diagnostics.hpp"
#include "butee/model/field_format.hpp"
#include "butee/model/model.hpp"
#include "butee/model/output_request.hpp"

namespace butee::scene {

/// Reads [output]; without it 1000 equal intervals and a probe of u on every loaded node. Mistakes go to `diagnostics`.
/// `model` need not be complete where there were mistakes before. `formats` are those known beside csv.
BUTEE_EXPORT model::OutputRequest read_output(const config::Value& root, const model::Model& model, double end_time,
                                              config::Diagnostics& diagnostics,
                                              const std::vector<model::FieldFormat>& formats = {});

}  // namespace butee::scene
