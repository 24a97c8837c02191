#include "butee/config/toml_order.hpp"

#include <algorithm>
#include <map>
#include <tuple>

#include "butee/config/toml_limits.hpp"

namespace butee::config {
namespace {

/// The lines from one header to the next.
struct Section {
  std::size_t begin = 0, end = 0;
  std::int32_t line = 1;          ///< line number of its header
  std::vector<std::string> path;  ///< names in the header; empty for the lines before the first header
  bool is_list = false;           ///< [[path]]
};

/// Reads "[a.b]" or "[[a.b]]" at `at`; false for anything else, which is left to toml11 to report.
bool read_header(const std::string& text, std::size_t at, Section& section) {
  const auto skip_blanks = [&] { at = std::min(text.find_first_not_of(" \t", at), text.size()); };
  section.is_list = text.compare(at, 2, "[[") == 0;
  for (at += section.is_list ? 2 : 1; at < text.size(); ++at) {
    skip_blanks();
    const std::size_t begin = at;
    if (at < text.size() && (text[at] == '"' || text[at] == '\'')) {
      at = end_of_string(text, at);
      if (at < begin + 2) return false;
      section.path.push_back(text.substr(begin + 1, at - begin - 2));
    } else {
      at = std::min(text.find_first_of(" \t.]\n", at), text.size());
      section.path.push_back(text.substr(begin, at - begin));
    }
    skip_blanks();
    if (at >= text.size() || text[at] != '.') break;
  }
  return text.compare(at, section.is_list ? 2 : 1, section.is_list ? "]]" : "]") == 0;
}

std::vector<Section> sections_of(const std::string& text) {
  std::vector<Section> sections(1);
  std::int32_t line = 1;
  int depth = 0;
  bool line_begins = true;
  for (std::size_t at = 0; at < text.size();) {
    const char c = text[at];
    std::size_t next = at + 1;
    if (c == '[' && depth == 0 && line_begins) {
      Section section;
      section.begin = text.find_last_of('\n', at) + 1;
      section.line = line;
      if (read_header(text, at, section)) sections.push_back(std::move(section));
      next = std::min(text.find('\n', at), text.size());
    } else if (c == '"' || c == '\'') {
      next = end_of_string(text, at);
    } else if (c == '#') {
      next = std::min(text.find('\n', at), text.size());
    } else if (c == '[' || c == '{') {
      ++depth;
    } else if (c == ']' || c == '}') {
      depth = std::max(depth - 1, 0);
    }
    line_begins = c == '\n' || (line_begins && (c == ' ' || c == '\t'));
    line += static_cast<std::int32_t>(std::count(text.begin() + static_cast<std::ptrdiff_t>(at),
                                                 text.begin() + static_cast<std::ptrdiff_t>(next), '\n'));
    at = next;
  }
  for (std::size_t i = 0; i < sections.size(); ++i)
    sections[i].end = i + 1 < sections.size() ? sections[i + 1].begin : text.size();
  return sections;
}

/// For each section the one that it must precede; its own index if it may stay.
std::vector<std::size_t> places_of(const std::vector<Section>& sections) {
  std::vector<std::size_t> places;
  std::map<std::string, int> elements;             // number so far for each list, by the list's full name
  std::map<std::string, std::size_t> first_parts;  // first section whose longer header names a table, by the table's
                                                   // full name
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const Section& section = sections[i];
    places.push_back(i);
    std::string name;
    for (std::size_t k = 0; k < section.path.size(); ++k) {
      name += std::string(1, '\0') + section.path[k];
      const bool is_last = k + 1 == section.path.size();
      const auto part = first_parts.find(name);
      if (is_last && !section.is_list && part != first_parts.end()) places.back() = part->second;
      if (is_last && section.is_list) ++elements[name];
      if (!is_last) {
        first_parts.try_emplace(name, i);
        if (const auto count = elements.find(name); count != elements.end())
          name += std::string(1, '\1') + std::to_string(count->second);
      }
    }
  }
  return places;
}

}  // namespace

std::int32_t OrderedText::original(std::int32_t line) const {
  if (lines.empty() || line < 1) return line;
  return lines[std::min(static_cast<std::size_t>(line), lines.size()) - 1];
}

OrderedText tables_before_their_parts(const std::string& text) {
  const std::vector<Section> sections = sections_of(text);
  const std::vector<std::size_t> places = places_of(sections);
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < sections.size(); ++i) order.push_back(i);
  if (places == order) return {text, {}};
  // Tables moved to the same place are nested: the outer ones first.
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const auto key = [&](std::size_t i) { return std::tuple(places[i], places[i] == i, sections[i].path.size()); };
    return key(a) < key(b);
  });
  OrderedText ordered;
  for (const std::size_t i : order) {
    const Section& section = sections[i];
    std::string part = text.substr(section.begin, section.end - section.begin);
    if (!part.empty() && part.back() != '\n') part += '\n';
    for (std::int32_t line = section.line; line < section.line + std::count(part.begin(), part.end(), '\n'); ++line)
      ordered.lines.push_back(line);
    ordered.text += part;
  }
  return ordered;
}

}  // namespace butee::config
