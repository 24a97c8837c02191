#pragma once

#include "butee/model/field_format.hpp"
#include "butee/model/output_request.hpp"
#include "butee/model/system.hpp"

namespace butee::record {

/// The positions of the requested nodes, for pictures of the whole scene.
///
/// A beam lies along x at its own coordinates, u is along y, and beams lie side by side in z,
/// separated by 5 % of the longest one. A beam that shares a node with an earlier one is moved
/// along x until the node's positions agree, and continues in the same line if that is free. A lone
/// node is placed beside the beams, at the x of the node to which a spring or a stop connects it;
/// without beams lone nodes are 1 m apart along x. A joined node has one name for each of its
/// beams.
BUTEE_EXPORT model::FieldLayout make_layout(const model::Model& model, const model::System& system,
                                            const model::FieldRequest& request);

}  // namespace butee::record
