#pragma once

#include "butee/config/diagnostics.hpp"
#include "butee/model/types.hpp"

namespace butee::scene {

/// The keys of the root table that read_model() reads; `[integrator]` and `[output]` are read
/// elsewhere.
BUTEE_EXPORT std::vector<std::string> model_keys();

/// Reads the mechanical part of a scene. Every error goes to `diagnostics`; the model is usable
/// only if there is none. `types` are the elements, sections, laws and loads that a scene may name.
BUTEE_EXPORT model::Model read_model(const config::Value& root, const model::ModelTypes& types,
                                     config::Diagnostics& diagnostics);

/// The nodes that the selectors in `key` name, without repetition, or nothing after an error. For
/// readers of other tables.
BUTEE_EXPORT std::optional<std::vector<model::NodeId>> read_nodes(const model::NodeTable& nodes,
                                                                  const config::Parameters& parameters,
                                                                  const std::string& key,
                                                                  config::Diagnostics& diagnostics);

/// The one node that the selector in `key` names, or nothing after an error.
BUTEE_EXPORT std::optional<model::NodeId> read_node(const model::NodeTable& nodes, const config::Parameters& parameters,
                                                    const std::string& key, config::Diagnostics& diagnostics);

}  // namespace butee::scene
