#include <algorithm>

#include "butee/config/toml.hpp"
#include "butee/study/study.hpp"

namespace butee::study {

using config::Value;

Layout layout_of(const Study& study) {
  using Type = Column::Type;
  constexpr std::size_t kStatusLength = 16, kReasonLength = 240, kHashLength = 16, kLongestValue = 120;
  std::vector<Column> columns = {{kRunColumn, "1", Type::integer}, {kPointColumn, "1", Type::integer}};
  if (study.plan.follow() != Follow::no) columns.push_back({kDirectionColumn, "1", Type::integer});
  for (const Axis& axis : study.plan.axes()) {
    if (axis.is_numeric()) {
      columns.push_back({axis.key, ""});
      continue;
    }
    std::size_t longest = 1;
    for (const Value& value : axis.values)
      longest = std::max(longest, value.text() != nullptr ? value.text()->size() : config::to_toml(value).size());
    columns.push_back({axis.key, "", Type::text, std::min(longest, kLongestValue)});
  }
  columns.push_back({kStatusColumn, "", Type::text, kStatusLength});
  columns.push_back({kReasonColumn, "", Type::text, kReasonLength});
  for (const Item& item : study.items) columns.push_back(column_of(item, study.periods.value_or(0)));
  if (study.steady) columns.push_back({kSettledColumn, "1", Type::integer});
  columns.push_back({kSceneColumn, "", Type::text, kHashLength});
  columns.push_back({kStepsColumn, "1", Type::integer});
  for (const char* name : {kFactorizationsColumn, kSolvesColumn, kAssembliesColumn})
    columns.push_back({name, "1", Type::integer, 1, true});
  columns.push_back({kSecondsColumn, "s", Type::number, 1, true});
  return Layout(std::move(columns));
}

}  // namespace butee::study
