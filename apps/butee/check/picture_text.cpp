#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <butee/core/text.hpp>

#include "picture.hpp"

namespace butee::app::check {
namespace {

constexpr int kMostRows = 12, kNarrowest = 40, kWidest = 120, kMostName = 14;

/// The characters of a picture.
struct Glyphs {
  std::string beam, node, above, below, support, clamp, load, moment, spring, mass, lone, between;
};
const Glyphs kBoxes = {"━", "╋", "▼", "▲", "△", "▐", "↕", "↻", "≷", "●", "●", "┆"};
const Glyphs kPlain = {"=", "+", "v", "^", "A", "|", "I", "@", "z", "O", "o", ":"};

/// One line of cells; each cell holds one character of any number of bytes.
class Line {
 public:
  explicit Line(int width) : cells_(static_cast<std::size_t>(width), " ") {}

  void put(int column, const std::string& glyph) {
    if (column >= 0 && column < static_cast<int>(cells_.size())) cells_[static_cast<std::size_t>(column)] = glyph;
  }
  void write(int column, const std::string& ascii) {
    for (const char c : ascii) put(column++, std::string(1, c));
  }
  bool is_free(int column, int length) const {
    for (int i = column; i < column + length; ++i)
      if (i < 0 || i >= static_cast<int>(cells_.size()) || cells_[static_cast<std::size_t>(i)] != " ") return false;
    return true;
  }
  std::string text() const {
    std::size_t end = cells_.size();
    while (end > 0 && cells_[end - 1] == " ") --end;
    std::string text;
    for (std::size_t i = 0; i < end; ++i) text += cells_[i];
    return text.empty() ? "" : text + "\n";
  }

 private:
  std::vector<std::string> cells_;
};

class TextDrawing {
 public:
  TextDrawing(const Layout& layout, int width, bool utf8)
      : layout_(layout), glyphs_(utf8 ? kBoxes : kPlain), width_(std::clamp(width, kNarrowest, kWidest)) {
    for (int row = 0; row < layout.rows; ++row)
      name_width_ = std::max(name_width_, static_cast<int>(names_in(row).size()));
    name_width_ = std::min(name_width_, kMostName) + 2;
  }

  std::string draw() const {
    std::string text;
    const int rows = std::min(layout_.rows, kMostRows);
    for (int row = 0; row < rows; ++row) text += draw_row(row);
    if (rows < layout_.rows) text += "(and " + std::to_string(layout_.rows - rows) + " rows more)\n";
    text += supports();
    for (std::size_t i = 0; i < layout_.stop_labels.size(); ++i)
      text += stops_of(static_cast<int>(i)) + "stops: " + layout_.stop_labels[i] + "\n";
    return text;
  }

 private:
  /// Legend of the support symbols that occur in the picture.
  std::string supports() const {
    bool u = false, theta = false;
    for (const SupportMark& support : layout_.supports) {
      u = u || support.u;
      theta = theta || support.theta;
    }
    std::string text;
    if (u) text += glyphs_.support + " displacement held   ";
    if (theta) text += glyphs_.clamp + " rotation held";
    while (!text.empty() && text.back() == ' ') text.pop_back();
    return text.empty() ? "" : text + "\n";
  }

  /// The symbols of a group of stops; the positive side is drawn above.
  std::string stops_of(int group) const {
    bool above = false, below = false, between = false;
    for (const StopMark& stop : layout_.stops) {
      if (stop.group != group) continue;
      between = between || stop.other.has_value();
      above = above || (!stop.other && stop.positive);
      below = below || (!stop.other && stop.negative);
    }
    std::string text;
    for (const auto& [is_there, glyph] :
         {std::pair{above, glyphs_.above}, std::pair{below, glyphs_.below}, std::pair{between, glyphs_.between}})
      if (is_there) text += glyph + " ";
    return text;
  }

  /// "collar, pipe"
  std::string names_in(int row) const {
    std::string names;
    for (const Body& body : layout_.bodies)
      if (body.row == row) names += (names.empty() ? "" : ", ") + body.name;
    return names;
  }

  int column(double x) const {
    const double span = layout_.right - layout_.left;
    const int room = width_ - name_width_ - 1;
    return name_width_ + (span > 0.0 ? static_cast<int>(std::lround((x - layout_.left) / span * room)) : room / 3);
  }

  std::string draw_row(int row) const {
    Line loads(width_), above(width_), beam(width_), below(width_), length(width_), link(width_);
    beam.write(0, names_in(row).substr(0, static_cast<std::size_t>(name_width_ - 1)));
    for (const Body& body : layout_.bodies) {
      if (body.row != row) continue;
      if (body.lone) {
        beam.put(column(body.begin), glyphs_.lone);
        continue;
      }
      for (int c = column(body.begin); c <= column(body.end); ++c) beam.put(c, glyphs_.beam);
      for (const double end : {body.begin, body.end}) beam.put(column(end), glyphs_.node);
      const std::string words =
          to_short_text(body.end - body.begin) + " m, " + std::to_string(body.nodes.size() - 1) + " elements";
      const int middle = (column(body.begin) + column(body.end) - static_cast<int>(words.size())) / 2;
      length.write(std::clamp(middle, name_width_, std::max(name_width_, width_ - static_cast<int>(words.size()))),
                   words);
    }
    for (const MassMark& mass : layout_.masses)
      if (mass.at.row == row) beam.put(column(mass.at.x), glyphs_.mass);
    for (const SpringMark& spring : layout_.springs) {
      // Beside the node, because a stop or a support may be drawn below it.
      if (!spring.b && spring.a.row == row) below.put(column(spring.a.x) - 2, glyphs_.spring);
      if (spring.b && std::min(spring.a.row, spring.b->row) == row) link.put(column(spring.a.x), glyphs_.spring);
    }
    for (const StopMark& stop : layout_.stops) {
      if (stop.other) {
        if (std::min(stop.at.row, stop.other->row) == row) link.put(column(stop.at.x), glyphs_.between);
        continue;
      }
      if (stop.at.row != row) continue;
      if (stop.positive) above.put(column(stop.at.x), glyphs_.above);
      if (stop.negative) below.put(column(stop.at.x), glyphs_.below);
    }
    for (const SupportMark& support : layout_.supports) {
      if (support.at.row != row) continue;
      if (support.u) below.put(column(support.at.x), glyphs_.support);
      if (support.theta) beam.put(column(support.at.x), glyphs_.clamp);
    }
    draw_loads(row, loads);
    return loads.text() + above.text() + beam.text() + below.text() + length.text() + link.text();
  }

  void draw_loads(int row, Line& line) const {
    for (const LoadMark& load : layout_.loads) {
      const std::string& glyph = load.moment ? glyphs_.moment : glyphs_.load;
      for (const Place& place : load.at)
        if (place.row == row) line.put(column(place.x), glyph);
      const Place& place = load.at.back();
      if (place.row != row) continue;
      const int size = static_cast<int>(load.label.size()), right = column(place.x) + 2;
      const int left = column(load.at.front().x) - 1 - size;
      if (line.is_free(right, size))
        line.write(right, load.label);
      else if (line.is_free(left, size))
        line.write(left, load.label);
    }
  }

  const Layout& layout_;
  const Glyphs& glyphs_;
  int width_, name_width_ = 0;
};

}  // namespace

std::string picture_text(const Layout& layout, int width, bool utf8) {
  return TextDrawing(layout, width, utf8).draw();
}

bool locale_is_utf8() {
  for (const char* name : {"LC_ALL", "LC_CTYPE", "LANG"}) {
    const char* value = std::getenv(name);
    if (value == nullptr || *value == '\0') continue;
    std::string text = value;
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text.find("utf-8") != std::string::npos || text.find("utf8") != std::string::npos;
  }
  return false;
}

}  // namespace butee::app::check
