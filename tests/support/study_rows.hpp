#pragma once

#include <string>
#include <vector>

#include <butee/study/store.hpp>

namespace butee::test {

/// The rows of a study that is complete, in the order of the plan, as CSV lines without the columns of cost.
std::vector<std::string> rows_without_cost(const std::string& study_file, const std::string& folder,
                                           const std::string& format);

/// The same of one file of rows, of which not all may be there.
std::vector<std::string> rows_in_file(const std::string& study_file, const std::string& rows_file,
                                      const std::string& format);

}  // namespace butee::test
