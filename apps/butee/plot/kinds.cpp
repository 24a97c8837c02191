#include "kinds.hpp"

#include <algorithm>
#include <array>

#include <butee/core/error.hpp>
#include <butee/core/log.hpp>
#include <butee/core/text.hpp>

#include "contact_pictures.hpp"
#include "frame.hpp"
#include "orbits.hpp"
#include "pictures.hpp"
#include "shape.hpp"

namespace butee::app::plot {
namespace {

using model::Quantity;
using Draw = std::function<std::vector<Picture>(const Drawing&)>;

/// The named kinds that show one quantity over time.
struct OverTime {
  const char* kind;
  Quantity quantity;
  const char* text;
};
constexpr std::array<OverTime, 6> kOverTime = {{{"force", Quantity::contact_force, "contact force"},
                                                {"moment", Quantity::bending_moment, "bending moment"},
                                                {"shear", Quantity::shear_force, "shear force"},
                                                {"stress", Quantity::bending_stress, "bending stress"},
                                                {"spring", Quantity::spring_force, "spring force"},
                                                {"reaction", Quantity::reaction, "reaction"}}};

std::string probe_of(const std::string& quantities) {
  return "[[output.probe]] with quantities = [" + quantities + "]";
}

constexpr const char* kFieldsNeeded =
    "the displacements of all nodes: run again with --set 'output.formats=[\"csv\", \"hdf5\"]'";

Draw of_charts(std::function<std::vector<Chart>(const Drawing&)> charts) {
  return [charts = std::move(charts)](const Drawing& drawing) {
    std::vector<Picture> pictures;
    for (const Chart& chart : charts(drawing)) pictures.push_back(chart.picture());
    return pictures;
  };
}

template <class OfRun>
Draw of_each_run(OfRun of_run) {
  return [of_run](const Drawing& drawing) {
    std::vector<Picture> pictures;
    for (const Result& result : drawing.results)
      for (Picture& picture : of_run(drawing, result)) pictures.push_back(std::move(picture));
    return pictures;
  };
}

/// Pictures from the fields of all nodes; of several runs only if asked for.
template <class OfFields>
Draw of_all_nodes(OfFields of_fields) {
  return of_each_run([of_fields](const Drawing& drawing, const Result& result) -> std::vector<Picture> {
    if (result.field_format.empty() || (drawing.several() && !drawing.asked_for)) return {};
    const auto* format = model::find_type(drawing.catalogue.types().formats, result.field_format);
    if (format == nullptr) {
      const std::string reason = result.folder + ": its fields are in the format " + result.field_format +
                                 ", whose module is not installed (hdf5: install libhdf5-dev and build butee again)";
      if (drawing.asked_for) throw InputError(reason);
      log::warning(reason);
      return {};
    }
    return of_fields(result, *format->open(result.folder), drawing.window, drawing.several());
  });
}

Kind kind_over_time(const std::string& name, Quantity quantity, const std::string& text) {
  const std::string column = model::name_of(quantity);
  return {name, "a probe of " + column + ": " + probe_of("\"" + column + "\""), of_charts([=](const Drawing& drawing) {
            return over_time(drawing, name, column, text, model::unit_of(quantity));
          })};
}

/// "torque about the beam's own axis x (T)"
Kind kind_over_time(Quantity quantity) {
  const std::string name = model::name_of(quantity), summary = model::summary_of(quantity);
  const bool is_rate =
      model::order_of(quantity) > 0;  // The summary of a rate refers to that of the quantity before it.
  const std::string text = is_rate ? name : summary.substr(0, summary.find_first_of(",;:")) + " (" + name + ")";
  return kind_over_time(name, quantity, text);
}

}  // namespace

const std::vector<Kind>& named_kinds() {
  static const std::vector<Kind> kinds = [] {
    std::vector<Kind> all;
    all.push_back(
        {"displacement", "a probe of a displacement or rotation: " + probe_of("\"u\""), of_charts(of_motion)});
    for (const OverTime& one : kOverTime) all.push_back(kind_over_time(one.kind, one.quantity, one.text));
    all.push_back({"step", "rows in history.csv", of_charts(of_steps)});
    all.push_back({"energy", "energies: run again with --set output.energy=true", of_charts(of_energy)});
    all.push_back({"phase", "a probe of u and v: " + probe_of("\"u\", \"v\""), of_charts(of_phase)});
    all.push_back({"spectrum", "a probe of u: " + probe_of("\"u\""), of_charts(of_spectrum)});
    const std::string in_plane = "a probe of uy and uz: " + probe_of("\"uy\", \"uz\"");
    all.push_back({"orbit", in_plane, of_charts(of_orbit)});
    all.push_back({"full-spectrum", in_plane, of_charts(of_full_spectrum)});
    all.push_back({"run-up", "a speed of [rotation] that varies and " + in_plane, of_charts(of_run_up)});
    all.push_back({"contact-map", "closings of contacts: run again with --set output.impacts=true",
                   of_each_run([](const Drawing& drawing, const Result& result) {
                     return contact_map(result, drawing.window, drawing.several());
                   })});
    all.push_back({"wear",
                   "wear: contacts in the plane, with dissipation or friction, that touch; run again with --set "
                   "output.impacts=true",
                   of_each_run([](const Drawing& drawing, const Result& result) {
                     return wear_picture(result, drawing.several());
                   })});
    all.push_back({"shape", kFieldsNeeded, of_all_nodes(shape_pictures)});
    all.push_back({"frame",
                   std::string("beams that do not all lie along x (--kind shape draws those) or ") + kFieldsNeeded,
                   of_all_nodes(frame_pictures)});
    return all;
  }();
  return kinds;
}

std::vector<Kind> default_kinds(const std::vector<Result>& results) {
  std::vector<Kind> kinds = named_kinds();
  std::vector<Quantity> seen;
  for (const OverTime& one : kOverTime) seen.push_back(one.quantity);
  for (const Result& result : results)
    for (const Probe& probe : result.probes)
      for (const Quantity quantity : probe.quantities) {
        if (model::source_of(quantity) == model::Source::motion || quantity == Quantity::stop_state ||
            std::find(seen.begin(), seen.end(), quantity) != seen.end())
          continue;
        seen.push_back(quantity);
        kinds.push_back(kind_over_time(quantity));
      }
  return kinds;
}

Kind kind_of(const std::string& name) {
  std::vector<std::string> names;
  for (const Kind& kind : named_kinds()) {
    if (kind.name == name) return kind;
    names.push_back(kind.name);
  }
  std::vector<std::string> known = model::probe_quantities();
  if (std::find(known.begin(), known.end(), name) != known.end()) return kind_over_time(model::quantity_of(name));
  known.insert(known.begin(), names.begin(), names.end());
  throw InputError("--kind " + name + ": there is no such kind" + suggestion(name, known) + "; known: " + join(names) +
                   ", or a quantity of probes (`butee help output`)");
}

}  // namespace butee::app::plot
