#include "contact_pictures.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>

#include <butee/study/table.hpp>

#include "../gnuplot.hpp"

namespace butee::app::plot {
namespace {

namespace fs = std::filesystem;

/// Most closings in a picture; those with the largest forces are kept.
constexpr std::size_t kMostClosings = 20000;
/// Least width of a drawn closing, as a fraction of the picture's width.
constexpr double kNarrowest = 1.0 / 700.0;
/// Most contacts for which the axis shows every name.
constexpr std::size_t kMostNames = 16;

/// Rows of cells, accessed by the column names of the first line; empty if the file is missing. Incomplete
/// lines are skipped.
class Rows {
 public:
  explicit Rows(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::string line;
    if (std::getline(file, line)) names_ = study::cells_of(line);
    while (std::getline(file, line) && !file.eof())
      if (auto cells = study::cells_of(line); cells.size() == names_.size()) rows_.push_back(std::move(cells));
  }
  std::size_t size() const { return rows_.size(); }
  const std::string& text(std::size_t row, const char* name) const {
    static const std::string none;
    const auto found = std::find(names_.begin(), names_.end(), name);
    return found == names_.end() ? none : rows_[row][static_cast<std::size_t>(found - names_.begin())];
  }
  double number(std::size_t row, const char* name, double otherwise = 0.0) const {
    const std::string& cell = text(row, name);
    double value = otherwise;
    std::from_chars(cell.data(), cell.data() + cell.size(), value);
    return value;
  }

 private:
  std::vector<std::string> names_;
  std::vector<std::vector<std::string>> rows_;
};

const ContactPlace* place_of(const Result& result, const std::string& node) {
  for (const ContactPlace& place : result.contact_places)
    if (place.node == node) return &place;
  return nullptr;
}

std::string title_of(const Result& result) {
  return "set title \"" + folded_title(result.title.empty() ? result.label : result.title) + "\" noenhanced\n";
}

/// gnuplot commands for the axis of contact positions, extended by `beyond` at both ends. Labels are metres
/// or contact names, of which every n-th is shown if there are many.
std::string place_axis(const Result& result, const char* axis, double beyond) {
  const std::string name = axis;
  double least = INFINITY, most = -INFINITY;
  for (const ContactPlace& place : result.contact_places) {
    least = std::min(least, place.x);
    most = std::max(most, place.x);
  }
  const double room = (most > least ? 0.05 * (most - least) : 0.5) + beyond;
  std::string text =
      "set " + name + "range [" + short_number(least - room, 7) + ":" + short_number(most + room, 7) + "]\n";
  if (result.contacts_along_x) return text + "set " + name + "label 'x / m'\n";
  text += "set " + name + "label 'contact'\nset " + name + "tics noenhanced (";
  const std::size_t stride = (result.contact_places.size() - 1) / kMostNames + 1;
  for (std::size_t i = 0; i < result.contact_places.size(); i += stride)
    text += (i > 0 ? ", " : "") + gnuplot::quoted(result.contact_places[i].node) + " " + std::to_string(i + 1);
  return text + ")\n";
}

/// The smallest distance between the positions of two contacts; 1 if there are no two positions.
double least_distance(const Result& result) {
  double least = INFINITY;
  for (const ContactPlace& a : result.contact_places)
    for (const ContactPlace& b : result.contact_places)
      if (b.x > a.x) least = std::min(least, b.x - a.x);
  return std::isfinite(least) ? least : 1.0;
}

/// Half of the width of a mark in the picture, m: narrow beside a structure with few contacts, and apart from others.
double half_width(const Result& result) {
  double farthest = 0.0;
  for (const ContactPlace& place : result.contact_places) farthest = std::max(farthest, std::abs(place.x));
  const double apart = 0.35 * least_distance(result);
  return farthest > 0.0 ? std::min(apart, 0.05 * farthest) : apart;
}

struct Closing {
  double begin, end, x, force;
};

}  // namespace

std::vector<Picture> contact_map(const Result& result, Window window, bool several) {
  const Rows rows(fs::path(result.folder) / "impacts.csv");
  double last = result.history.rows() > 0 ? result.history.times().back() : 0.0;
  for (std::size_t i = 0; i < rows.size(); ++i) last = std::max(last, rows.number(i, "t_out", rows.number(i, "t_in")));
  std::vector<Closing> closings;
  std::size_t moments = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const ContactPlace* place = place_of(result, rows.text(i, "node"));
    const double begin = std::max(rows.number(i, "t_in"), window.from);
    const double end = std::min(rows.number(i, "t_out", last), window.to);
    if (place == nullptr || !(begin <= end)) continue;
    closings.push_back({begin, end, place->x, rows.number(i, "peak_force")});
    const std::optional<DofKind> dof = dof_named(rows.text(i, "dof"));
    moments += dof && is_rotation(*dof) ? 1 : 0;
  }
  if (closings.empty()) return {};
  const std::size_t found = closings.size();
  std::sort(closings.begin(), closings.end(), [](const Closing& a, const Closing& b) { return a.force > b.force; });
  closings.resize(std::min(found, kMostClosings));
  // The largest forces are drawn last, over the others.
  std::reverse(closings.begin(), closings.end());
  const Scale time = scale_for(last, "s"), force = moments == 0 || moments == found
                                                       ? scale_for(closings.back().force, moments == 0 ? "N" : "N m")
                                                       : Scale{1.0, "N or N m"};
  Picture picture;
  picture.name = several ? "contact-map-" + result.label : "contact-map";
  picture.data = "# middle of the time, place, begin, end, lower, upper edge, largest force\n$closings << EOD\n";
  const double begin = std::max(window.from, 0.0), end = std::min(window.to, last);
  const double half = half_width(result), narrow = kNarrowest * (end - begin);
  for (const Closing& one : closings) {
    const double until = std::max(one.end, one.begin + narrow);
    for (const double value : {0.5 * (one.begin + until) * time.factor, one.x, one.begin * time.factor,
                               until * time.factor, one.x - half, one.x + half})
      picture.data += short_number(value, 8) + " ";
    picture.data += short_number(one.force * force.factor, 6) + "\n";
  }
  picture.data += "EOD\n";
  const std::string shown =
      found > kMostClosings ? "the hardest " + std::to_string(kMostClosings) + " of " + std::to_string(found) : "";
  picture.set =
      title_of(result) + place_axis(result, "y", half) + "set xlabel " + gnuplot::quoted(time.axis("time")) +
      "\nset xrange [" + short_number(begin * time.factor, 7) + ":" + short_number(end * time.factor, 7) +
      "]\nset cblabel " +
      gnuplot::quoted(force.axis(moments == found ? "largest moment of a contact" : "largest force of a contact")) +
      " offset 1" +
      "\nset cbrange [0:*]\nset palette defined (0 '#c6dbef', 0.4 '#4292c6', 0.7 '#d62728', 1 '#67000d')\n"
      "set rmargin at screen 0.84\n" +
      gnuplot::legend_below(shown.empty() ? std::vector<std::string>{} : std::vector{shown});
  picture.plot = "plot $closings using 1:2:3:4:5:6:7 with boxxyerror fs solid noborder lc palette " +
                 (shown.empty() ? std::string("notitle") : "title " + gnuplot::quoted(shown));
  return {picture};
}

std::vector<Picture> wear_picture(const Result& result, bool several) {
  const Rows rows(fs::path(result.folder) / "wear.csv");
  double most = 0.0;
  for (std::size_t i = 0; i < rows.size(); ++i) most = std::max(most, rows.number(i, "mean_power"));
  if (most <= 0.0) return {};
  const Scale power = scale_for(most, "W");
  Picture picture;
  picture.name = several ? "wear-" + result.label : "wear";
  picture.data = "# place, mean power, share of the time in contact\n$wear << EOD\n";
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (const ContactPlace* place = place_of(result, rows.text(i, "node")); place != nullptr)
      picture.data += short_number(place->x, 8) + " " + short_number(rows.number(i, "mean_power") * power.factor, 6) +
                      " " + short_number(100.0 * rows.number(i, "contact_share"), 6) + "\n";
  picture.data += "EOD\n";
  const std::string work = "mean power of the normal force along the slip", share = "share of the time in contact";
  const std::string colour(gnuplot::kColours[0]), other(gnuplot::kColours[1]);
  picture.set = title_of(result) + place_axis(result, "x", 0.0) + "set ylabel " +
                gnuplot::quoted(power.axis("wear power")) +
                "\nset yrange [0:*]\nset border 11\nset y2tics\nset y2range [0:*]\nset y2label 'in contact / %'\n"
                "set rmargin at screen 0.9\n" +
                gnuplot::legend_below({work, share});
  picture.plot = "plot $wear using 1:2 with impulses lw 7 lc rgb '" + colour + "' title " + gnuplot::quoted(work) +
                 ", \\\n     $wear using 1:3 axes x1y2 with points pt 7 ps 0.8 lc rgb '" + other + "' title " +
                 gnuplot::quoted(share);
  return {picture};
}

}  // namespace butee::app::plot
