#pragma once

#include "butee/record/result_folder.hpp"
#include "butee/scene/read_scene.hpp"

namespace butee::run {

/// Throws InputError for a run whose results exceed the free space, that would overwrite the results it starts from
/// ([initial] from), and for one that starts later than t = 0 and requests trust, which is available only for runs
/// from t = 0.
BUTEE_EXPORT void check_start(const scene::Scene& scene, const record::ResultFolder& folder);

}  // namespace butee::run
