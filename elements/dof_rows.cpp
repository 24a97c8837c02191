#include "elements/dof_rows.hpp"

#include <algorithm>

#include "butee/core/error.hpp"
#include "butee/core/text.hpp"

namespace butee::elements {

using model::NodeId;

namespace {

std::optional<NodeId> number_in(std::string_view text) {
  const auto number = whole_number<NodeId>(text);
  return number.value_or(-1) < 0 ? std::nullopt : number;
}

}  // namespace

NodeId largest_own(const std::string& selector, const std::string& name) {
  if (name.empty() || !selector.starts_with(name + ":")) return -1;
  const auto dots = selector.find("..");
  return number_in(std::string_view(selector).substr(dots == std::string::npos ? name.size() + 1 : dots + 2))
      .value_or(-1);
}

std::vector<DofRow> rows_in(std::string_view text, const std::string& name) {
  std::vector<DofRow> rows;
  std::size_t number = 0;
  while (!text.empty()) {
    const auto end = std::min(text.find('\n'), text.size());
    std::string line(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    ++number;
    const auto refuse = [&](const std::string& what) { throw InputError(":" + std::to_string(number) + ": " + what); };
    std::replace_if(
        line.begin(), line.end(), [](char c) { return c == ',' || c == '\t' || c == '\r'; }, ' ');
    std::vector<std::string> words;
    for (std::size_t at = 0; (at = line.find_first_not_of(' ', at)) != std::string::npos;) {
      const auto stop = std::min(line.find(' ', at), line.size());
      words.push_back(line.substr(at, stop - at));
      at = stop;
    }
    if (words.empty() || words.front().front() == '#' || words.front().front() == '%') continue;
    if (words.size() != 2) refuse("must hold a node and a degree of freedom, such as \"17 uy\" or \"shaft:last rz\"");
    const auto kind = dof_named(words[1]);
    if (!kind) refuse("\"" + printable(words[1]) + "\" is not a degree of freedom; give one of ux, uy, uz, rx, ry, rz");
    DofRow row{words[0], number_in(words[0]).value_or(largest_own(words[0], name)), kind, std::to_string(number)};
    if (row.own >= kMostNodes) refuse("own nodes are numbered below " + std::to_string(kMostNodes));
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace butee::elements
