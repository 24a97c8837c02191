#pragma once

#include "../session.hpp"

namespace butee::app::studies {

/// True for the file of a study of `butee study`. Throws InputError where it cannot be read.
bool names_study(const std::string& path);

/// `butee check STUDY.toml`: points, columns, estimated time and size, by up to three runs of at most some seconds.
/// Throws InputError with what is wrong with the study.
void print_study_survey(const ModelArguments& arguments, bool as_json);

}  // namespace butee::app::studies
