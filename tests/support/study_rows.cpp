#include "support/study_rows.hpp"

namespace butee::test {
namespace {

std::string without_cost(const study::Layout& layout, const study::Row& row) {
  study::Row copy = row;
  for (std::size_t i = 0; i < layout.columns().size(); ++i) {
    if (!layout.columns()[i].is_cost) continue;
    if (layout.columns()[i].type == study::Column::Type::integer)
      copy.set_integer(i, 0);
    else
      copy.set(i, 0.0);
  }
  return csv_line(layout, copy);
}

}  // namespace

std::vector<std::string> rows_in_file(const std::string& study_file, const std::string& rows_file,
                                      const std::string& format) {
  const study::Study study = study::load_study(study_file);
  const study::Layout layout = layout_of(study);
  const auto source = study::row_format(format)->open(rows_file, layout);
  std::vector<std::byte> bytes(layout.row_bytes());
  std::vector<std::string> rows;
  for (std::int64_t i = 0; i < source->size(); ++i)
    if (source->read(i, bytes)) rows.push_back(without_cost(layout, study::Row(layout, bytes)));
  return rows;
}

std::vector<std::string> rows_without_cost(const std::string& study_file, const std::string& folder,
                                           const std::string& format) {
  return rows_in_file(study_file, folder + "/study" + study::row_format(format)->extension(), format);
}

}  // namespace butee::test
