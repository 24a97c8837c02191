#include "pictures.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>

#include <butee/config/parameters.hpp>
#include <butee/core/error.hpp>
#include <butee/core/format.hpp>

#include "../gnuplot.hpp"
#include "../plot/scale.hpp"

namespace butee::app::studies {
namespace {

using plot::Picture;
using plot::Scale;
using study::Column;
using study::Follow;
using study::Item;
using study::Row;

constexpr const char *kUp = "#1f77b4", *kDown = "#d62728";
/// The colours of matplotlib's viridis; older versions of gnuplot lack this palette.
constexpr const char* kPalette =
    "set palette defined (0 '#440154', 0.25 '#3b528b', 0.5 '#21918c', 0.75 '#5ec962', 1 '#fde725')\n";
constexpr std::size_t kMostBins = 60;

std::string number(double value) {
  return std::isfinite(value) ? formatted("%.9g", value) : "NaN";
}

std::string file_name(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return std::isalnum(c) == 0 && c != '.' && c != '-'; }, '-');
  return text;
}

/// The intervals around the values of a numeric axis, which meet halfway between neighbours.
class Cells {
 public:
  explicit Cells(const study::Axis& axis) : is_logarithmic_(axis.range && axis.range->is_logarithmic) {
    for (std::int64_t i = 0; i < axis.size(); ++i)
      if (const auto value = config::as_number(axis.value(i))) places_.push_back(to_place(*value));
    std::sort(places_.begin(), places_.end());
    places_.erase(std::unique(places_.begin(), places_.end()), places_.end());
  }

  std::pair<double, double> around(double value) const {
    const double place = to_place(value);
    const auto i = std::min<std::size_t>(
        static_cast<std::size_t>(std::lower_bound(places_.begin(), places_.end(), place) - places_.begin()),
        places_.size() - 1);
    return {to_value(place - 0.5 * step(i, -1)), to_value(place + 0.5 * step(i, 1))};
  }

  /// From the first interval to the last, for gnuplot.
  std::string range() const {
    return "[" + number(around(to_value(places_.front())).first) + ":" +
           number(around(to_value(places_.back())).second) + "]";
  }

 private:
  double to_place(double value) const { return is_logarithmic_ ? std::log(value) : value; }
  double to_value(double place) const { return is_logarithmic_ ? std::exp(place) : place; }
  /// The distance to the next value on a side; at an end that of the other side.
  double step(std::size_t i, int side) const {
    if (places_.size() == 1) return places_[0] == 0.0 ? 1.0 : 0.2 * std::abs(places_[0]);
    if (side > 0 ? i + 1 == places_.size() : i == 0) side = -side;
    return side > 0 ? places_[i + 1] - places_[i] : places_[i] - places_[i - 1];
  }

  bool is_logarithmic_;
  std::vector<double> places_;
};

/// The rows of a study as numeric columns for pictures.
class Drawing {
 public:
  Drawing(const study::Study& study, const study::Layout& layout, const study::Store& store)
      : study_(study),
        layout_(layout),
        store_(store),
        first_axis_(layout.find(study::kStatusColumn) - axes()),
        first_item_(layout.find(study::kReasonColumn) + 1) {}

  std::vector<Picture> all() {
    std::vector<Picture> pictures;
    const study::PlanKind kind = study_.plan.kind();
    const bool is_random = kind == study::PlanKind::sobol || kind == study::PlanKind::latin;
    const bool is_numeric =
        std::all_of(study_.plan.axes().begin(), study_.plan.axes().end(), [](const auto& a) { return a.is_numeric(); });
    for (std::size_t i = 0; i < study_.items.size(); ++i) {
      const bool is_section = study_.items[i].kind == Item::Kind::section;
      if (is_random && !is_section) pictures.push_back(histogram(i));
      if (is_numeric && axes() == 1 && !is_random) pictures.push_back(over_axis(i, is_section));
      if (is_numeric && axes() == 2 && kind == study::PlanKind::grid && !is_section)
        for (const int direction : directions()) pictures.push_back(map(i, direction));
      if (is_section && study_.items[i].quantity == model::Quantity::u)
        if (const auto v = speed_of(study_.items[i])) pictures.push_back(poincare(i, *v));
    }
    return pictures;
  }

 private:
  std::size_t axes() const { return study_.plan.axes().size(); }
  std::string title() const { return study_.title.empty() ? study_.stem : study_.title; }

  /// The section of v that belongs to a section of u.
  std::optional<std::size_t> speed_of(const Item& item) const {
    for (std::size_t i = 0; i < study_.items.size(); ++i) {
      const Item& other = study_.items[i];
      if (other.kind == Item::Kind::section && other.probe == item.probe && other.quantity == model::Quantity::v)
        return i;
    }
    return std::nullopt;
  }

  const Column& column(std::size_t item) const { return layout_.columns()[first_item_ + item]; }

  Scale scale_of(std::size_t item) const {
    double largest = 0.0;
    store_.visit([&](const Row& row) {
      for (std::size_t k = 0; k < column(item).length; ++k)
        if (const double value = std::abs(row.number(first_item_ + item, k)); value > largest) largest = value;
    });
    const std::string unit = column(item).unit == "1" ? "" : column(item).unit;
    return plot::scale_for(largest, unit);
  }

  /// The axis label of an item: "peak rotor.u / mm".
  std::string label(std::size_t item, const Scale& scale) const {
    return gnuplot::quoted(scale.axis(study_.items[item].text)) + " noenhanced";
  }

  void begin(Picture& picture, const std::string& name) const {
    picture.name = file_name(name);
    picture.set = "set title \"" + plot::folded_title(title()) + "\" noenhanced\nunset key\n";
  }

  std::string is_logarithmic(std::size_t axis, const char* which) const {
    const auto& range = study_.plan.axes()[axis].range;
    return range && range->is_logarithmic ? std::string("set logscale ") + which + "\n" : "";
  }

  std::string axis_label(std::size_t axis) const {
    const study::Axis& drawn = study_.plan.axes()[axis];
    return gnuplot::quoted(drawn.label.empty() ? drawn.key : drawn.label) + " noenhanced";
  }

  Picture over_axis(std::size_t item, bool is_section) const {
    Picture picture;
    begin(picture, (is_section ? "bifurcation-" : "response-") + study_.items[item].text);
    const Scale scale = scale_of(item);
    std::map<int, std::string> blocks;
    double points = 0.0;
    store_.visit([&](const Row& row) {
      const int direction = direction_of(row);
      points += static_cast<double>(column(item).length);
      for (std::size_t k = 0; k < column(item).length; ++k)
        blocks[direction] +=
            number(row.number(first_axis_)) + " " + number(row.number(first_item_ + item, k) * scale.factor) + "\n";
    });
    // Few points are large, and many a cloud.
    const std::string size = to_short_text(std::clamp(10.0 / std::sqrt(points), 0.15, 0.6), 2);
    const auto style = [&](const char* colour) {
      return is_section ? " with points pt 7 ps " + size + " lc rgb '" + colour + "'"
                        : std::string(" with linespoints pt 7 ps 0.35 lw 1.2 lc rgb '") + colour + "'";
    };
    picture.plot = "plot ";
    std::vector<std::string> entries;
    // The upward sweep is drawn last, so that it stays visible where both coincide.
    for (const auto& [direction, block] : blocks) {
      const std::string name = direction < 0 ? "$down" : direction > 0 ? "$up" : "$runs";
      picture.data += name + " << EOD\n" + block + "EOD\n";
      if (picture.plot != "plot ") picture.plot += ", \\\n     ";
      picture.plot += name + style(direction < 0 ? kDown : kUp);
      if (blocks.size() > 1 || direction != 0) {
        entries.push_back(direction < 0 ? "down" : "up");
        picture.plot += " title '" + entries.back() + "'";
      } else {
        picture.plot += " notitle";
      }
    }
    if (!entries.empty()) picture.set += "set key noenhanced\n" + gnuplot::legend_below(entries);
    picture.set += "set xlabel " + axis_label(0) + "\nset ylabel " + label(item, scale) + "\n" + is_logarithmic(0, "x");
    return picture;
  }

  /// The directions of the sweeps: +1 is up and -1 down; 0 alone without sweeps.
  std::vector<int> directions() const {
    switch (study_.plan.follow()) {
      case Follow::no:
        return {0};
      case Follow::up:
        return {1};
      case Follow::down:
        return {-1};
      default:
        return {1, -1};
    }
  }

  int direction_of(const Row& row) const {
    return study_.plan.follow() == Follow::no ? 0
                                              : static_cast<int>(row.integer(layout_.find(study::kDirectionColumn)));
  }

  /// A cell around every run of a direction, in its colour.
  Picture map(std::size_t item, int direction) const {
    Picture picture;
    const bool has_both = directions().size() > 1;
    const std::string sweep = direction > 0 ? "up" : "down";
    begin(picture, "map-" + study_.items[item].text + (has_both ? "-" + sweep : ""));
    if (has_both)
      picture.set = "set title \"" + plot::folded_title(title() + ", sweep " + sweep) + "\" noenhanced\nunset key\n";
    const Scale scale = scale_of(item);
    const Cells columns(study_.plan.axes()[0]), lines(study_.plan.axes()[1]);
    picture.data = "$map << EOD\n";
    store_.visit([&](const Row& row) {
      if (direction_of(row) != direction) return;
      const double x = row.number(first_axis_), y = row.number(first_axis_ + 1);
      const double value = row.number(first_item_ + item) * scale.factor;
      if (!std::isfinite(value)) return;
      const auto [left, right] = columns.around(x);
      const auto [low, high] = lines.around(y);
      for (const double place : {x, y, left, right, low, high}) picture.data += number(place) + " ";
      picture.data += number(value) + "\n";
    });
    picture.data += "EOD\n";
    picture.set += std::string(kPalette) + "set xlabel " + axis_label(0) + "\nset ylabel " + axis_label(1) +
                   "\nset cblabel " + label(item, scale) + "\n" + is_logarithmic(0, "x") + is_logarithmic(1, "y") +
                   "set xrange " + columns.range() + "\nset yrange " + lines.range() + "\n";
    picture.plot = "plot $map using 1:2:3:4:5:6:7 with boxxyerror fs solid noborder lc palette notitle";
    return picture;
  }

  Picture poincare(std::size_t u, std::size_t v) const {
    Picture picture;
    begin(picture, "poincare-" + study_.items[u].probe);
    const Scale of_u = scale_of(u), of_v = scale_of(v);
    const bool has_colour = axes() > 0 && study_.plan.axes().front().is_numeric() && study_.plan.point_count() > 1;
    picture.data = "$section << EOD\n";
    store_.visit([&](const Row& row) {
      for (std::size_t k = 0; k < column(u).length; ++k)
        picture.data += number(row.number(first_item_ + u, k) * of_u.factor) + " " +
                        number(row.number(first_item_ + v, k) * of_v.factor) +
                        (has_colour ? " " + number(row.number(first_axis_)) : "") + "\n";
    });
    picture.data += "EOD\n";
    picture.set += "set xlabel " + label(u, of_u) + "\nset ylabel " + label(v, of_v) + "\n";
    if (has_colour) picture.set += std::string(kPalette) + "set cblabel " + axis_label(0) + "\n";
    picture.plot = std::string("plot $section with points pt 7 ps 0.2 lc ") +
                   (has_colour ? "palette" : "rgb '#222222'") + " notitle";
    return picture;
  }

  Picture histogram(std::size_t item) const {
    Picture picture;
    begin(picture, "histogram-" + study_.items[item].text);
    const Scale scale = scale_of(item);
    std::vector<double> values;
    store_.visit([&](const Row& row) {
      if (const double value = row.number(first_item_ + item); std::isfinite(value))
        values.push_back(value * scale.factor);
    });
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    const double begin_at = values.empty() ? 0.0 : *least;
    const double span = values.empty() || *most == *least ? 1.0 : *most - *least;
    const auto wanted = static_cast<std::size_t>(std::sqrt(static_cast<double>(values.size())));
    std::vector<std::size_t> bins(std::clamp<std::size_t>(wanted, 1, kMostBins));
    const double width = span / static_cast<double>(bins.size());
    for (const double value : values)
      ++bins[std::min(bins.size() - 1, static_cast<std::size_t>((value - begin_at) / width))];
    picture.data = "$bins << EOD\n";
    for (std::size_t i = 0; i < bins.size(); ++i)
      picture.data += number(begin_at + (static_cast<double>(i) + 0.5) * width) + " " + std::to_string(bins[i]) + "\n";
    picture.data += "EOD\n";
    picture.set += "set xlabel " + label(item, scale) + "\nset ylabel 'runs'\nset yrange [0:*]\nset boxwidth " +
                   number(width) + "\nset style fill solid 0.6\n";
    picture.plot = std::string("plot $bins with boxes lc rgb '") + kUp + "' notitle";
    return picture;
  }

  const study::Study& study_;
  const study::Layout& layout_;
  const study::Store& store_;
  std::size_t first_axis_, first_item_;
};

}  // namespace

std::vector<Picture> study_pictures(const study::Study& study, const study::Layout& layout, const study::Store& store) {
  return Drawing(study, layout, store).all();
}

std::vector<std::string> draw_folder(const std::string& folder, const std::string& to,
                                     const std::vector<std::string>& formats) {
  const study::Study study = study::Store::read(folder);
  const study::Layout layout = layout_of(study);
  const auto format = study::row_format(study::Store::extension_in(folder) == ".csv" ? "csv" : "hdf5");
  study::Store store(folder, study, layout, *format);
  store.adopt_identity();
  store.look();
  if (store.done_count() == 0) throw InputError(folder + ": holds no rows yet");
  return draw_study(study, layout, store, formats, to);
}

std::vector<std::string> draw_study(const study::Study& study, const study::Layout& layout, const study::Store& store,
                                    const std::vector<std::string>& formats, const std::string& to) {
  const std::string folder = to.empty() ? store.file("plots") : to;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw RunError(folder + ": cannot be created: " + error.message());
  std::vector<std::string> made, drawn = formats;
  const bool keeps_script = std::erase(drawn, "script") > 0;
  for (const Picture& picture : study_pictures(study, layout, store)) {
    gnuplot::write_script(folder, picture.name, picture.script(drawn.empty() ? gnuplot::formats() : drawn));
    if (keeps_script) made.push_back(folder + "/" + picture.name + ".gp");
    if (drawn.empty()) continue;
    const std::string complaint = gnuplot::run_script(folder, picture.name);
    if (!complaint.empty())
      throw RunError("gnuplot could not draw " + folder + "/" + picture.name + ".gp: " + complaint);
    for (const std::string& format : drawn) made.push_back(folder + "/" + picture.name + "." + format);
  }
  return made;
}

}  // namespace butee::app::studies
