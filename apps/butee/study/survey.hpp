#pragma once

#include "../session.hpp"

namespace butee::app::studies {

/// True if the file describes a study of `butee study`. Throws InputError if it cannot be read.
bool names_study(const std::string& path);

/// `butee check STUDY.toml`: points, columns, estimated time and size from up to three trial runs of a few
/// seconds at most. Throws InputError with all mistakes of the study.
void print_study_survey(const ModelArguments& arguments, bool as_json);

}  // namespace butee::app::studies
