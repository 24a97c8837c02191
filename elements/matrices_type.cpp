#include <algorithm>
#include <filesystem>
#include <numeric>

#include "butee/config/file_reference.hpp"
#include "butee/core/error.hpp"
#include "butee/core/text.hpp"
#include "elements/dof_rows.hpp"
#include "elements/matrices.hpp"
#include "elements/matrix_market.hpp"

namespace butee::elements {
namespace {

using config::Diagnostics;
using config::Parameters;
using model::NodalDof;
using model::NodeId;

/// Differences between entries (i, j) and (j, i) up to this fraction of the largest entry are
/// rounding of printed numbers.
constexpr double kRounding = 1e-12;

bool names_kinds(const Parameters& p) {
  const auto dofs = p.texts("dofs");
  return dofs.size() != 1 || dof_named(dofs.front()).has_value();
}

std::string read_file_of(const Parameters& p, const std::string& key, const Diagnostics& diagnostics) {
  const std::string text = config::read_text(config::path_beside(diagnostics.document(), p.texts(key).front()));
  if (!p.has("checksums")) return text;
  std::size_t place = 0;
  for (const char* other : {"mass", "stiffness", "damping", "gyroscopic", "dofs"}) {
    if (key == other) break;
    if (p.has(other)) ++place;
  }
  const auto checksums = p.texts("checksums");
  const std::string change = place < checksums.size() ? config::change_of(text, 0, checksums[place]) : "";
  if (!change.empty()) throw InputError(change);
  return text;
}

/// Calls read(text) with the text of a file; if it throws, reports an error about `key` with the
/// file's line.
template <class Read>
bool with_file(const Parameters& p, const std::string& key, Diagnostics& diagnostics, Read read) {
  try {
    read(read_file_of(p, key, diagnostics));
    return true;
  } catch (const InputError& error) {
    const std::string what = error.what(), file = std::filesystem::path(p.texts(key).front()).filename().string();
    p.complain(diagnostics, key, what.front() == ':' ? printable(file) + what : what);
    return false;
  }
}

std::optional<SparseMatrix> read_matrix(const Parameters& p, const std::string& key, Diagnostics& diagnostics) {
  SparseMatrix matrix;
  if (p.has(key) &&
      !with_file(p, key, diagnostics, [&](const std::string& text) { matrix = read_matrix_market(text); }))
    return std::nullopt;
  return matrix;
}

std::string own_name(const Parameters& p) {
  return p.has("name") ? p.text("name") : "";
}

/// The nodes that the element creates: as many as it numbers.
model::ElementType::Nodes own_nodes(const Parameters& p, Diagnostics& diagnostics) {
  NodeId count = 0;
  if (!names_kinds(p)) {
    if (p.has("nodes")) {
      p.complain(diagnostics, "nodes", "conflicts with a file of dofs, which names the nodes; give one of the two");
      return std::nullopt;
    }
    if (!with_file(p, "dofs", diagnostics, [&](const std::string& text) {
          for (const DofRow& row : rows_in(text, own_name(p))) count = std::max(count, row.own + 1);
        }))
      return std::nullopt;
  } else if (p.has("nodes")) {
    for (const std::string& selector : p.texts("nodes")) {
      const NodeId own = largest_own(selector, own_name(p));
      if (own >= kMostNodes) {
        p.complain(diagnostics, "nodes", "own nodes are numbered below " + std::to_string(kMostNodes));
        return std::nullopt;
      }
      count = std::max(count, own + 1);
    }
  } else {
    const auto mass = read_matrix(p, "mass", diagnostics);
    if (!mass) return std::nullopt;
    const Index kinds = std::ssize(p.texts("dofs"));
    if (kinds == 0 || mass->rows() % kinds != 0) {
      p.complain(diagnostics, "dofs",
                 "names " + std::to_string(kinds) + " degrees of freedom of each node, and mass has " +
                     std::to_string(mass->rows()) + " rows, which is not a multiple of that");
      return std::nullopt;
    }
    count = static_cast<NodeId>(mass->rows() / kinds);
  }
  if (count == 0) return std::nullopt;
  if (!p.has("coordinates")) {
    std::vector<double> x(static_cast<std::size_t>(count));
    std::iota(x.begin(), x.end(), 0.0);
    return x;
  }
  auto x = p.numbers("coordinates");
  if (std::ssize(x) != count)
    p.complain(diagnostics, "coordinates",
               "holds " + std::to_string(x.size()) + " numbers; the element has " + std::to_string(count) + " nodes");
  if (std::adjacent_find(x.begin(), x.end(), std::greater_equal<>()) != x.end())
    p.complain(diagnostics, "coordinates", "must ascend: every coordinate larger than the one before");
  return x;
}

class Maker {
 public:
  Maker(const Parameters& p, model::ElementContext& context) : p_(p), context_(context) {}

  std::unique_ptr<model::Element> make() {
    std::array<SparseMatrix, 4> matrices;
    bool ok = true;
    for (std::size_t i = 0; i < matrices.size(); ++i) {
      auto matrix = read_matrix(p_, kKeys[i], context_.diagnostics());
      ok = ok && matrix;
      if (matrix) matrices[i] = std::move(*matrix);
    }
    ok = ok && sizes_match(matrices) && structure_fits(matrices);
    const auto dofs = names_kinds(p_) ? dofs_of_nodes() : dofs_of_file();
    if (!dofs || !ok) return nullptr;
    if (std::ssize(*dofs) != matrices[0].rows()) {
      p_.complain(context_.diagnostics(), "dofs",
                  "names " + std::to_string(dofs->size()) + " rows" +
                      (names_kinds(p_) ? " with the nodes (every one for each node)" : "") + ", and mass has " +
                      std::to_string(matrices[0].rows()));
      return nullptr;
    }
    return std::make_unique<Matrices>(*dofs, matrices[0], matrices[1], matrices[2], matrices[3]);
  }

 private:
  static constexpr std::array<const char*, 4> kKeys = {"mass", "stiffness", "damping", "gyroscopic"};

  bool sizes_match(const std::array<SparseMatrix, 4>& matrices) {
    bool ok = true;
    for (std::size_t i = 1; i < matrices.size(); ++i) {
      if (!p_.has(kKeys[i]) || matrices[i].rows() == matrices[0].rows()) continue;
      p_.complain(context_.diagnostics(), kKeys[i],
                  "has " + std::to_string(matrices[i].rows()) + " rows, and mass has " +
                      std::to_string(matrices[0].rows()) + "; all matrices are of one size");
      ok = false;
    }
    return ok;
  }

  bool structure_fits(const std::array<SparseMatrix, 4>& matrices) {
    const auto differs = [&](std::size_t i, double sign) {
      const SparseMatrix difference = matrices[i] - sign * SparseMatrix(matrices[i].transpose());
      return difference.size() > 0 &&
             difference.coeffs().cwiseAbs().maxCoeff() > kRounding * matrices[i].coeffs().cwiseAbs().maxCoeff();
    };
    if (matrices[0].nonZeros() > 0 && differs(0, 1.0)) {
      p_.complain(context_.diagnostics(), "mass", "is not symmetric");
      return false;
    }
    if (matrices[3].nonZeros() > 0 && differs(3, -1.0)) {
      p_.complain(context_.diagnostics(), "gyroscopic",
                  "is not skew-symmetric; it is G in the force -Omega G v of a turning part");
      return false;
    }
    for (Index i = 0; i < matrices[0].rows(); ++i)
      if (matrices[0].coeff(i, i) < 0.0) {
        p_.complain(context_.diagnostics(), "mass",
                    "has a negative entry on the diagonal, in row " + std::to_string(i + 1));
        return false;
      }
    return true;
  }

  std::optional<std::vector<NodalDof>> dofs_of_nodes() {
    std::vector<NodeId> nodes;
    if (p_.has("nodes")) {
      const auto selected = context_.nodes(p_, "nodes");
      if (!selected) return std::nullopt;
      nodes = *selected;
    } else {
      const auto mass = read_matrix(p_, "mass", context_.diagnostics());
      if (!mass) return std::nullopt;
      nodes.resize(static_cast<std::size_t>(mass->rows() / std::ssize(p_.texts("dofs"))));
      std::iota(nodes.begin(), nodes.end(), context_.own_node());
    }
    std::vector<NodalDof> dofs;
    const auto kinds = p_.texts("dofs");
    for (const std::string& kind : kinds)
      if (!dof_named(kind)) {
        p_.complain(
            context_.diagnostics(), "dofs",
            "names \"" + printable(kind) + "\", which is not a degree of freedom; give ux, uy, uz, rx, ry or rz");
        return std::nullopt;
      }
    for (std::size_t i = 0; i < kinds.size(); ++i)
      for (std::size_t k = 0; k < i; ++k)
        if (dof_named(kinds[i]) == dof_named(kinds[k])) {
          p_.complain(context_.diagnostics(), "dofs", "names " + kinds[i] + " twice");
          return std::nullopt;
        }
    for (const NodeId node : nodes)
      for (const std::string& kind : kinds) dofs.push_back({node, *dof_named(kind)});
    return dofs;
  }

  std::optional<std::vector<NodalDof>> dofs_of_file() {
    std::vector<NodalDof> dofs;
    if (!with_file(p_, "dofs", context_.diagnostics(), [&](const std::string& text) {
          for (const DofRow& row : rows_in(text, own_name(p_))) dofs.push_back(dof_of(row));
          refuse_doubles(text, dofs);
        }))
      return std::nullopt;
    if (is_excused_) return std::nullopt;
    return dofs;
  }

  NodalDof dof_of(const DofRow& row) {
    if (row.own >= 0) return {context_.own_node() + row.own, *row.kind};
    const model::Selection selection = context_.select(row.node);
    if (!selection.problem.empty() || selection.nodes.size() > 1)
      throw InputError(":" + row.where + ": \"" + printable(row.node) + "\": " +
                       (selection.problem.empty() ? "names several nodes; a row is of one" : selection.problem));
    is_excused_ = is_excused_ || selection.excused;
    return {selection.nodes.empty() ? 0 : selection.nodes.front(), *row.kind};
  }

  void refuse_doubles(const std::string& text, const std::vector<NodalDof>& dofs) {
    std::vector<std::size_t> order(dofs.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto key = [&](std::size_t i) { return std::pair(context_.canonical(dofs[i].node), dofs[i].kind); };
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
    for (std::size_t i = 1; i < order.size() && !is_excused_; ++i)
      if (key(order[i]) == key(order[i - 1])) {
        const auto rows = rows_in(text, own_name(p_));
        throw InputError(":" + rows[order[i]].where + ": this degree of freedom was named in line " +
                         rows[order[i - 1]].where + " before");
      }
  }

  const Parameters& p_;
  model::ElementContext& context_;
  bool is_excused_ = false;
};

}  // namespace

model::ElementType matrices_type() {
  using config::text, config::texts;
  return {
      "matrices",
      "any linear structure, by Matrix Market files of its matrices",
      {text("mass", "the file of M, relative to the scene; symmetric"), text("stiffness", "the file of K"),
       text("damping", "the file of C, in addition to [damping]").optional(),
       text("gyroscopic", "the file of G, skew-symmetric: the force -Omega G v if the part turns").optional(),
       texts("dofs",
             "the degrees of freedom of each node, such as [\"uy\", \"rz\"], or a file with a row \"NODE DOF\" for "
             "each row of the matrices"),
       texts("nodes",
             "the nodes of the rows, node by node, own ones (NAME:0..48) and those of other elements; default: all own")
           .optional(),
       config::numbers("coordinates", "m", "the coordinates of the own nodes, for pictures; default 0, 1, 2 ...")
           .optional(),
       texts("checksums", "CRC-64 of the files in the order above, as in model.toml").optional()},
      own_nodes,
      [](const Parameters& p, model::ElementContext& context) { return Maker(p, context).make(); }};
}

}  // namespace butee::elements
