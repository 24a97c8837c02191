#include "report.hpp"

#include <algorithm>

#include <butee/core/format.hpp>
#include <butee/core/text.hpp>

#include "../gnuplot.hpp"

namespace butee::app::modes {
namespace {

using model::NodalDof;
using model::NodeId;

/// An effective mass below this fraction of the total is printed as zero.
constexpr double kNoMass = 1e-12;

std::string exact(double value) {
  return formatted("%.17g", value);
}

/// The value of a shape at a DOF; 0 if the DOF is held, empty if it does not exist.
std::string cell(const Analysis& analysis, const model::DofTable& dofs, NodalDof dof, Index mode) {
  const Index row = dofs.index(dof);
  if (row == model::DofTable::kAbsent) return "";
  return row < 0 ? "0" : exact(analysis.shapes(row, mode));
}

/// The first nodes of all groups, in the order of the file.
std::vector<const model::NodeGroup*> groups_of(const model::NodeTable& nodes) {
  std::vector<const model::NodeGroup*> groups;
  for (const std::string& name : nodes.group_names()) groups.push_back(nodes.find(name));
  return groups;
}

/// The displacement of a mode that is drawn, the largest one, and the factor that makes it 1.
struct Drawn {
  DofKind kind = DofKind::u;
  double scale = 0.0;
};

std::vector<Drawn> drawn_of(const Analysis& analysis, const model::Model& model, const model::DofTable& dofs) {
  std::vector<Drawn> drawn(analysis.modes.size());
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    double largest = 0.0;
    for (const DofKind kind : {DofKind::u, DofKind::uz, DofKind::ux})
      for (NodeId node = 0; node < model.nodes.size(); ++node) {
        const Index row = dofs.index({node, kind});
        const double size = row >= 0 ? std::abs(analysis.shapes(row, static_cast<Index>(i))) : 0.0;
        if (size > largest) drawn[i] = {kind, 1.0 / size};
        largest = std::max(largest, size);
      }
  }
  return drawn;
}

}  // namespace

void print(const Analysis& analysis) {
  if (!analysis.title.empty()) std::printf("%s\n", printable(analysis.title).c_str());
  std::printf("  %td free DOFs, %s kg", analysis.dofs, to_short_text(analysis.total_mass).c_str());
  if (analysis.stops > 0)
    std::printf(analysis.closed > 0 ? ", %td of %td stops closed" : ", all stops open", analysis.closed,
                analysis.stops);
  std::printf("\n\n  mode       rad/s            Hz     damping   effective mass (u)   sum  residual\n");
  double sum = 0.0;
  for (std::size_t i = 0; i < analysis.modes.size(); ++i) {
    const Mode& mode = analysis.modes[i];
    sum += mode.effective_part;
    const std::string mass = mode.effective_part < kNoMass ? "0" : formatted("%.4g", mode.effective_mass);
    std::printf("  %4zu  %10s  %12s  %10s  %11s kg %4.1f %% %4.1f %%  %8.0e%s\n", i + 1,
                to_short_text(mode.omega).c_str(), to_short_text(mode.frequency).c_str(),
                mode.damping ? formatted("%.4g", *mode.damping).c_str() : "-", mass.c_str(),
                100.0 * mode.effective_part, 100.0 * sum, mode.residual, mode.rigid ? "  rigid motion" : "");
  }
}

Json to_json(const Analysis& analysis) {
  Json json;
  json["title"] = analysis.title;
  json["dofs"] = analysis.dofs;
  json["stops"] = analysis.stops;
  json["closed_stops"] = analysis.closed;
  json["total_mass"] = analysis.total_mass;
  json["solver"] = analysis.dense ? "dense" : "lanczos";
  json["modes"] = Json::array();
  for (const Mode& mode : analysis.modes) {
    Json row;
    row["angular_frequency"] = mode.omega;
    row["frequency"] = mode.frequency;
    row["damping"] = mode.damping ? Json(*mode.damping) : Json();
    row["effective_mass"] = mode.effective_mass;
    row["effective_part"] = mode.effective_part;
    row["rigid"] = mode.rigid;
    row["residual"] = mode.residual;
    row["rounding"] = mode.rounding;
    json["modes"].push_back(std::move(row));
  }
  return json;
}

std::string frequencies_csv(const Analysis& analysis) {
  std::string text = "mode,angular_frequency,frequency,damping,effective_mass,effective_part,rigid,residual,rounding\n";
  for (std::size_t i = 0; i < analysis.modes.size(); ++i) {
    const Mode& mode = analysis.modes[i];
    text += std::to_string(i + 1) + "," + exact(mode.omega) + "," + exact(mode.frequency) + "," +
            (mode.damping ? exact(*mode.damping) : "") + "," + exact(mode.effective_mass) + "," +
            exact(mode.effective_part) + "," + (mode.rigid ? "1" : "0") + "," + exact(mode.residual) + "," +
            exact(mode.rounding) + "\n";
  }
  return text;
}

std::string shapes_csv(const Analysis& analysis, const model::Model& model, const model::System& system) {
  std::string text = "node,coordinate";
  const auto& free = system.dofs.free();
  std::vector<DofKind> kinds = {DofKind::u, DofKind::theta};
  for (const DofKind kind : {DofKind::ux, DofKind::uz, DofKind::rx, DofKind::ry})
    if (std::any_of(free.begin(), free.end(), [&](NodalDof dof) { return dof.kind == kind; })) kinds.push_back(kind);
  for (std::size_t i = 1; i <= analysis.modes.size(); ++i)
    for (const DofKind kind : kinds) text.append(1, ',').append(name_of(kind)).append(std::to_string(i));
  text += "\n";
  for (const model::NodeGroup* group : groups_of(model.nodes))
    for (NodeId i = 0; i < group->size(); ++i) {
      const NodeId node = group->first + i;
      text += model.nodes.name(node) + ",";
      if (!group->lone()) text += exact(group->coordinates[static_cast<std::size_t>(i)]);
      for (Index mode = 0; mode < std::ssize(analysis.modes); ++mode)
        for (const DofKind kind : kinds) text.append(1, ',').append(cell(analysis, system.dofs, {node, kind}, mode));
      text += "\n";
    }
  return text;
}

bool draw(const Analysis& analysis, const model::Model& model, const model::System& system,
          const record::ResultFolder& folder) {
  const std::vector<Drawn> drawn = drawn_of(analysis, model, system.dofs);
  std::string data, labels, plot;
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    for (const model::NodeGroup* group : groups_of(model.nodes)) {
      for (NodeId k = 0; k < group->size(); ++k) {
        const Index row = system.dofs.index({group->first + k, drawn[i].kind});
        const double u = row >= 0 ? analysis.shapes(row, static_cast<Index>(i)) : 0.0;
        data += exact(group->lone() ? 0.0 : group->coordinates[static_cast<std::size_t>(k)]) + " " +
                exact(0.4 * drawn[i].scale * u - static_cast<double>(i)) + "\n";
      }
      data += "\n";
    }
    data += "\n";
    const std::string place = std::to_string(i);
    labels += (i > 0 ? ", " : "") +
              formatted("'%zu: %.4g Hz%s' -%zu", i + 1, analysis.modes[i].frequency,
                        drawn[i].kind == DofKind::u ? "" : (", " + std::string(name_of(drawn[i].kind))).c_str(), i);
    plot += (i > 0 ? ", " : "plot ") + ("-" + place + " w l lc rgb '#c8c8c8' notitle, 'modes.dat' index " + place) +
            " w lp lw 1.6 pt 7 ps 0.3 lc rgb '#1f77b4' notitle";
  }
  folder.write("modes.dat", data);
  const double shape = 0.16 + 0.07 * static_cast<double>(drawn.size());
  const std::string script = "set xlabel 'coordinate / m'\nset border 1\nset xtics nomirror out\nset ytics scale 0 (" +
                             labels + ")\nset yrange [" + formatted("-%zu", drawn.size()) + "+0.3:0.7]\n";
  folder.write("modes.gp", script + gnuplot::draw_into({"png", "svg"}, "modes", plot, shape));
  return gnuplot::is_installed() && gnuplot::run_script(folder.path(), "modes").empty();
}

}  // namespace butee::app::modes
