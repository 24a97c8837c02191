#include "butee/run/check_start.hpp"

#include <filesystem>

#include "butee/config/file_reference.hpp"
#include "butee/core/error.hpp"

namespace butee::run {

void check_start(const scene::Scene& scene, const record::ResultFolder& folder) {
  const config::Value* initial = scene.document.root.table()->find("initial");
  const config::Value* from = initial != nullptr ? initial->table()->find("from") : nullptr;
  if (from == nullptr) return;
  const std::string key = describe(scene.document, from->at) + ": initial.from: ";
  std::error_code error;
  if (std::filesystem::equivalent(config::path_beside(scene.document, *from->text()), folder.path(), error))
    throw InputError(key + "is the folder that the results of this run would replace; choose another with -o");
  if (scene.output.trust && scene.model.initial_motion->time != 0.0)
    throw InputError(key + "trust works only for runs that begin at t = 0; remove keep_time");
}

}  // namespace butee::run
