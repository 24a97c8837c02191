#include "shape.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "../gnuplot.hpp"

namespace butee::app::plot {
namespace {

constexpr std::size_t kMostInstants = 600, kMostPlaces = 200;  ///< resolution of the picture
constexpr std::size_t kFewestPlaces = 100;
constexpr std::size_t kFewestNodes = 3;  ///< least number of nodes of a line worth a picture

std::optional<std::size_t> field_of(const model::FieldLayout& layout, const std::string& name) {
  for (std::size_t i = 0; i < layout.fields.size(); ++i)
    if (layout.fields[i].name == name) return i;
  return std::nullopt;
}

/// The direction of a line, a unit vector.
std::array<double, 3> direction_of(const model::FieldLayout& layout, const model::FieldLine& line) {
  std::array<double, 3> along = layout.positions[static_cast<std::size_t>(line.nodes.back())];
  const auto& start = layout.positions[static_cast<std::size_t>(line.nodes.front())];
  for (std::size_t axis = 0; axis < 3; ++axis) along[axis] -= start[axis];
  const double length = std::hypot(along[0], along[1], along[2]);
  for (double& part : along) part /= length > 0.0 ? length : 1.0;
  return along;
}

/// Evenly spaced records of the window.
std::vector<std::size_t> records_in(const std::vector<double>& times, Window window) {
  std::vector<std::size_t> all;
  for (std::size_t i = 0; i < times.size(); ++i)
    if (times[i] >= window.from && times[i] <= window.to) all.push_back(i);
  const std::size_t stride = (all.size() + kMostInstants - 1) / kMostInstants;
  if (stride <= 1) return all;
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < all.size(); i += stride) chosen.push_back(all[i]);
  return chosen;
}

/// For each line, the field that is drawn: u, unless the line points along u or another displacement across it is much
/// larger.
std::vector<std::optional<std::size_t>> drawn_fields(model::FieldReader& fields,
                                                     const std::vector<std::size_t>& records) {
  constexpr double kMuchLarger = 3.0, kAcross = 0.8;  // the latter: largest cosine to the line
  const model::FieldLayout& layout = fields.layout();
  std::vector<std::optional<std::size_t>> chosen(layout.lines.size());
  std::vector<double> sizes(layout.lines.size()), values(layout.nodes.size());
  for (const DofKind kind : {DofKind::uy, DofKind::uz, DofKind::ux}) {
    const auto is_kind = [kind](const model::Field& field) { return dof_named(field.name) == kind; };
    const auto found = std::find_if(layout.fields.begin(), layout.fields.end(), is_kind);
    if (found == layout.fields.end()) continue;
    const auto field = static_cast<std::size_t>(found - layout.fields.begin());
    std::vector<double> largest(layout.lines.size());
    for (const std::size_t record : records) {
      fields.read(record, field, values);
      for (std::size_t i = 0; i < largest.size(); ++i)
        for (const Index node : layout.lines[i].nodes)
          largest[i] = std::max(largest[i], std::abs(values[static_cast<std::size_t>(node)]));
    }
    for (std::size_t i = 0; i < largest.size(); ++i) {
      const double along = direction_of(layout, layout.lines[i])[static_cast<std::size_t>(axis_of(kind))];
      if (std::abs(along) > kAcross || (chosen[i] && largest[i] <= kMuchLarger * sizes[i])) continue;
      chosen[i] = field;
      sizes[i] = largest[i];
    }
  }
  return chosen;
}

/// The closed phase of a stop: begin and end in s, position in m.
struct Closure {
  double begin, end, place;
};

/// The data of one line's picture: u for each instant, at evenly spaced positions.
struct Map {
  std::vector<double> times, places;
  std::vector<std::vector<double>> u;
  std::vector<Closure> closures;
};

class Sampler {
 public:
  Sampler(const model::FieldLayout& layout, const model::FieldLine& line) : line_(line) {
    for (const Index node : line.nodes) x_.push_back(layout.coordinates[static_cast<std::size_t>(node)]);
    const std::size_t count = std::clamp(x_.size(), kFewestPlaces, kMostPlaces);
    std::size_t i = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const double part = static_cast<double>(k) / static_cast<double>(count - 1);
      const double x = x_.front() + part * (x_.back() - x_.front());
      while (i + 2 < x_.size() && x_[i + 1] < x) ++i;
      map.places.push_back(x);
      cells_.push_back({i, (x - x_[i]) / (x_[i + 1] - x_[i])});
    }
    closed_since_.resize(x_.size());
    if (x_.size() <= 2 * count) return;
    const double spacing = (x_.back() - x_.front()) / static_cast<double>(count - 1);
    for (const double x : x_) nearest_.push_back(static_cast<std::size_t>(std::lround((x - x_.front()) / spacing)));
  }

  void take(double t, std::span<const double> u) {
    map.times.push_back(t);
    std::vector<double>& row = map.u.emplace_back();
    if (nearest_.empty()) {
      for (const auto& [i, part] : cells_) row.push_back((1.0 - part) * value(u, i) + part * value(u, i + 1));
      return;
    }
    row.assign(map.places.size(), 0.0);
    for (std::size_t i = 0; i < nearest_.size(); ++i)
      if (double& most = row[nearest_[i]]; std::abs(value(u, i)) > std::abs(most)) most = value(u, i);
  }

  /// Tracks which stops are closed; called for every record.
  void follow(double t, double previous, std::span<const double> state) {
    for (std::size_t i = 0; i < x_.size(); ++i) {
      auto& since = closed_since_[i];
      if (value(state, i) != 0.0) {
        if (!since) since = t;
      } else if (since) {
        map.closures.push_back({*since, previous, x_[i]});
        since.reset();
      }
    }
  }
  void end(double t) {
    for (std::size_t i = 0; i < x_.size(); ++i)
      if (closed_since_[i]) map.closures.push_back({*closed_since_[i], t, x_[i]});
  }

  Map map;

 private:
  double value(std::span<const double> values, std::size_t i) const {
    return values[static_cast<std::size_t>(line_.nodes[i])];
  }

  struct Cell {
    std::size_t left;
    double part;
  };
  const model::FieldLine& line_;
  std::vector<double> x_;
  std::vector<Cell> cells_;
  std::vector<std::size_t> nearest_;  ///< position of each node, if positions take the largest value of several nodes
  std::vector<std::optional<double>> closed_since_;  ///< s, instant at which the stop closed, if it is closed
};

std::string rounded(double value) {
  return short_number(value, 5);
}

Picture picture_of(const Map& map, const std::string& quantity, const std::string& title, const std::string& name) {
  double largest = 0.0;
  for (const auto& row : map.u) largest = std::max(largest, largest_of(row));
  const Scale time = scale_for(map.times.back(), "s"), place = scale_for(largest_of(map.places), "m"),
              u = scale_for(largest, "m");
  Picture picture;
  picture.name = name;
  picture.data = "# the displacement: a line for each place, a number for each instant\n$u << EOD\n";
  for (std::size_t k = 0; k < map.places.size(); ++k) {
    for (std::size_t i = 0; i < map.times.size(); ++i)
      picture.data += (i > 0 ? " " : "") + short_number(map.u[i][k] * u.factor, 4);
    picture.data += "\n";
  }
  picture.data += "EOD\n";
  if (!map.closures.empty()) {
    picture.data += "# closed stops: from, place, until\n$closed << EOD\n";
    for (const Closure& c : map.closures)
      picture.data += rounded(c.begin * time.factor) + " " + rounded(c.place * place.factor) + " " +
                      rounded((c.end - c.begin) * time.factor) + "\n";
    picture.data += "EOD\n";
  }
  const double t0 = map.times.front() * time.factor, t1 = map.times.back() * time.factor;
  const double x0 = map.places.front() * place.factor, x1 = map.places.back() * place.factor;
  const double dt = (t1 - t0) / static_cast<double>(std::max<std::size_t>(map.times.size() - 1, 1));
  const double dx = (x1 - x0) / static_cast<double>(map.places.size() - 1);
  std::string heading = folded_title(title);
  picture.set = "set title \"" + heading + "\" noenhanced\nset xlabel " + gnuplot::quoted(time.axis("time")) +
                "\nset ylabel " + gnuplot::quoted(place.axis("place along the beam")) + "\nset cblabel " +
                gnuplot::quoted(u.axis(quantity)) + "\n";
  picture.set += "set palette defined (-1 '#2166ac', -0.5 '#92c5de', 0 '#f7f7f7', 0.5 '#f4a582', 1 '#b2182b')\n";
  const double limit = largest > 0.0 ? largest * u.factor : 1.0;
  picture.set += "set cbrange [" + rounded(-limit) + ":" + rounded(limit) +
                 "]\nset colorbox user origin screen 0.885, graph 0 size screen 0.02, graph 1\n";
  picture.set += "set xrange [" + rounded(t0) + ":" + rounded(t1) + "]\nset yrange [" + rounded(x0) + ":" +
                 rounded(x1) + "]\nset rmargin screen 0.87\nunset grid\n" + gnuplot::legend_below({"stop closed"});
  picture.plot = "plot $u matrix using (" + rounded(t0) + " + " + short_number(dt, 9) + " * $1):(" + rounded(x0) +
                 " + " + short_number(dx, 9) + " * $2):3 with image notitle";
  if (!map.closures.empty())
    picture.plot +=
        ", \\\n     $closed using 1:2:3:(0) with vectors nohead lw 1.6 lc rgb '#111111' notitle, \\\n"
        "     NaN with lines lw 1.6 lc rgb '#111111' title 'stop closed'";
  return picture;
}

}  // namespace

std::vector<Picture> shape_pictures(const Result& result, model::FieldReader& fields, Window window, bool several) {
  const model::FieldLayout& layout = fields.layout();
  const auto u = field_of(layout, "u"), state = field_of(layout, "stop_state");
  const auto records = records_in(fields.times(), window);
  if (records.size() < 2) return {};
  struct Drawn {
    const model::FieldLine* line;
    std::size_t field;
    Sampler sampler;
  };
  std::vector<Drawn> lines;
  const auto chosen = drawn_fields(fields, records);
  for (std::size_t i = 0; i < layout.lines.size(); ++i)
    if (const model::FieldLine& line = layout.lines[i]; line.nodes.size() >= kFewestNodes && chosen[i])
      lines.push_back({&line, *chosen[i], Sampler(layout, line)});
  std::vector<double> values(layout.nodes.size());
  for (std::size_t field = 0; field < layout.fields.size(); ++field) {
    if (std::none_of(lines.begin(), lines.end(), [&](const Drawn& drawn) { return drawn.field == field; })) continue;
    for (const std::size_t record : records) {
      fields.read(record, field, values);
      for (Drawn& drawn : lines)
        if (drawn.field == field) drawn.sampler.take(fields.times()[record], values);
    }
  }
  if (state) {
    for (std::size_t record = records.front(); record <= records.back(); ++record) {
      fields.read(record, *state, values);
      const double t = fields.times()[record], before = fields.times()[record - (record > records.front() ? 1 : 0)];
      for (Drawn& drawn : lines) drawn.sampler.follow(t, before, values);
    }
    for (Drawn& drawn : lines) drawn.sampler.end(fields.times()[records.back()]);
  }
  std::vector<Picture> pictures;
  for (const Drawn& drawn : lines) {
    std::string name = "shape", title = result.title.empty() ? result.label : result.title;
    if (several) name += "-" + result.label;
    if (lines.size() > 1) {
      name += "-" + drawn.line->name;
      title = drawn.line->name + ": " + title;
    }
    const bool is_u = u && drawn.field == *u;
    pictures.push_back(picture_of(
        drawn.sampler.map, is_u ? "displacement" : "displacement " + layout.fields[drawn.field].name, title, name));
  }
  return pictures;
}

}  // namespace butee::app::plot
