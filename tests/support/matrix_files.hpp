#pragma once

#include <string>

#include <butee/model/system.hpp>

namespace butee::test {

/// The matrix as a Matrix Market text with 17 digits; `structure` is "general", "symmetric" or "skew-symmetric".
std::string matrix_market(const SparseMatrix& matrix, const std::string& structure);

/// A file of dofs for the free DOFs of a table: one line "NODE DOF" for each row.
std::string dof_rows(const model::System& system, const model::NodeTable& nodes);

}  // namespace butee::test
