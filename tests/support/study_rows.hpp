#pragma once

#include <string>
#include <vector>

#include <butee/study/store.hpp>

namespace butee::test {

/// The rows of a complete study, in the order of the plan, as CSV lines without the cost columns.
std::vector<std::string> rows_without_cost(const std::string& study_file, const std::string& folder,
                                           const std::string& format);

/// The same for one file of rows, which may be incomplete.
std::vector<std::string> rows_in_file(const std::string& study_file, const std::string& rows_file,
                                      const std::string& format);

}  // namespace butee::test
