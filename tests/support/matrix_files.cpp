#include "support/matrix_files.hpp"

#include <sstream>

namespace butee::test {

std::string matrix_market(const SparseMatrix& matrix, const std::string& structure) {
  std::ostringstream entries;
  entries.precision(17);
  Index count = 0;
  for (Index j = 0; j < matrix.cols(); ++j)
    for (SparseMatrix::InnerIterator entry(matrix, j); entry; ++entry) {
      if (entry.value() == 0.0) continue;
      if (structure == "symmetric" && entry.row() < j) continue;
      if (structure == "skew-symmetric" && entry.row() <= j) continue;
      entries << entry.row() + 1 << " " << j + 1 << " " << entry.value() << "\n";
      ++count;
    }
  return "%%MatrixMarket matrix coordinate real " + structure + "\n" + std::to_string(matrix.rows()) + " " +
         std::to_string(matrix.cols()) + " " + std::to_string(count) + "\n" + entries.str();
}

std::string dof_rows(const model::System& system, const model::NodeTable& nodes) {
  std::string rows = "# node dof\n";
  for (const model::NodalDof& dof : system.dofs.free()) rows += nodes.name(dof.node) + " " + name_of(dof.kind) + "\n";
  return rows;
}

}  // namespace butee::test
