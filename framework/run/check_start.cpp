#include "butee/run/check_start.hpp"

#include <filesystem>

#include "butee/config/file_reference.hpp"
#include "butee/core/error.hpp"
#include "butee/core/log.hpp"
#include "butee/core/text.hpp"

namespace butee::run {

namespace {

/// A number in a CSV file with all its digits, bytes.
constexpr double kBytesOfNumber = 20.0;
/// Larger files are announced, bytes.
constexpr double kLarge = 5e9;

void check_size(const scene::Scene& scene, const std::string& folder) {
  const model::OutputRequest& output = scene.output;
  if (!output.interval || !output.csv) return;
  double columns = 2.0;  // t and h
  for (const model::ProbeRequest& probe : output.probes) columns += static_cast<double>(probe.quantities.size());
  const double begin = scene.model.initial_motion ? scene.model.initial_motion->time : 0.0;
  const double rows = (scene.integrator.options.end_time - begin) / *output.interval,
               bytes = kBytesOfNumber * rows * columns;
  std::error_code error;
  std::filesystem::path place = std::filesystem::absolute(folder, error);
  // The file of an earlier run is replaced, or continued.
  const auto present = std::filesystem::file_size(place / "history.csv", error);
  const double written = error ? 0.0 : static_cast<double>(present);
  while (!std::filesystem::exists(place, error) && place.has_relative_path()) place = place.parent_path();
  const std::filesystem::space_info disk = std::filesystem::space(place, error);
  const std::string size = "output.interval = " + to_text(*output.interval) + ": history.csv would have " +
                           to_short_text(rows) + " rows, about " + to_short_text(1e-9 * bytes) + " GB",
                    remedy = "; take a larger interval or fewer probes";
  // No such numbers: a file system that holds no files.
  if (error || disk.capacity == 0 || bytes < static_cast<double>(disk.available) + written) {
    if (bytes > kLarge) log::warning(size + remedy);
    return;
  }
  throw InputError(size + ", but " + to_short_text(1e-9 * static_cast<double>(disk.available)) + " GB are free in " +
                   place.string() + remedy);
}

}  // namespace

void check_start(const scene::Scene& scene, const record::ResultFolder& folder) {
  check_size(scene, folder.path());
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
