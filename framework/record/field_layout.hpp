#pragma once

#include "butee/model/field_format.hpp"
#include "butee/model/output_request.hpp"
#include "butee/model/system.hpp"

namespace butee::record {

/// Where the requested nodes stand, for pictures of the whole scene.
///
/// A beam lies along x at its own coordinates, u is along y, and beams lie side by side in z, 5 % of the longest one
/// apart. A beam that shares a node with an earlier one is moved along x until that node has one place, and goes on in
/// the same line where that is free. A lone node stands beside the beams, at the x of the node that a spring or a stop
/// ties it to; without beams lone nodes stand 1 m apart along x. A joined node has one name for each of its beams.
BUTEE_EXPORT model::FieldLayout make_layout(const model::Model& model, const model::System& system,
                                            const model::FieldRequest& request);

}  // namespace butee::record
