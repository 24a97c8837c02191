#include <algorithm>
#include <filesystem>

#include "butee/config/toml.hpp"
#include "butee/core/error.hpp"
#include "butee/study/store.hpp"

namespace butee::study {

namespace fs = std::filesystem;

namespace {

/// Number of bytes of rows written at once.
constexpr std::size_t kBlock = std::size_t{1} << 20U;

}  // namespace

struct Store::Found {
  struct Place {
    std::int32_t file = -1;
    std::int64_t index = 0;
  };
  std::vector<Place> places;  ///< by run
  std::vector<std::unique_ptr<RowSource>> sources;
};

Store::Found Store::find_rows(const std::vector<std::string>& files) const {
  Found found;
  found.places.resize(static_cast<std::size_t>(study_.plan.run_count()));
  std::vector<std::byte> bytes(layout_.row_bytes());
  const std::size_t run_column = layout_.find(kRunColumn);
  for (const std::string& path : files) {
    found.sources.push_back(open_rows(path));
    RowSource* source = found.sources.back().get();
    for (std::int64_t i = 0; source != nullptr && i < source->size(); ++i) {
      if (!source->read(i, bytes)) continue;
      const std::int64_t run = Row(layout_, bytes).integer(run_column);
      if (run < 0 || run >= std::ssize(found.places))
        throw RunError(path + ": contains a row that belongs to no run of this study");
      Found::Place& place = found.places[static_cast<std::size_t>(run)];
      if (place.file < 0) place = {static_cast<std::int32_t>(found.sources.size() - 1), i};
    }
  }
  return found;
}

bool Store::merge(std::int64_t& missing) {
  if (sink_) {
    flush();
    sink_->close();
    sink_.reset();
  }
  if (is_complete_) return true;
  const std::vector<std::string> files = all_row_files();
  Found found = find_rows(files);
  const auto& places = found.places;
  std::vector<std::byte> bytes(layout_.row_bytes());
  for (std::size_t run = 0; run < places.size(); ++run)
    if (places[run].file < 0) {
      missing = static_cast<std::int64_t>(run);
      return false;
    }
  const std::string draft = result() + ".part";
  const auto sink = format_.create(draft, layout_, study_.title);
  std::vector<std::byte> block;
  for (const Found::Place& place : places) {
    found.sources[static_cast<std::size_t>(place.file)]->read(place.index, bytes);
    block.insert(block.end(), bytes.begin(), bytes.end());
    if (block.size() < kBlock) continue;
    sink->append(block);
    block.clear();
  }
  if (!block.empty()) sink->append(block);
  sink->close();
  fs::rename(draft, result());
  found.sources.clear();
  std::error_code error;
  for (const std::string& path : files) fs::remove(path, error);
  remove_parts();
  is_complete_ = true;
  return true;
}

void Store::visit(const std::function<void(const Row&)>& look) const {
  std::vector<std::byte> bytes(layout_.row_bytes());
  if (is_complete_) {
    const auto source = format_.open(result(), layout_);
    for (std::int64_t i = 0; i < source->size(); ++i)
      if (source->read(i, bytes)) look(Row(layout_, bytes));
    return;
  }
  const Found found = find_rows(all_row_files());
  for (const Found::Place& place : found.places)
    if (place.file >= 0 && found.sources[static_cast<std::size_t>(place.file)]->read(place.index, bytes))
      look(Row(layout_, bytes));
}

Study Store::read(const std::string& folder) {
  const std::string from = study_in(folder);
  if (from.empty()) throw InputError(folder + ": is not a folder of a study");
  const config::Document known = config::load_toml((fs::path(from) / kStudyFile).string());
  const config::Value *study = known.root.table()->find("study"), *scene = known.root.table()->find("scene");
  if (study == nullptr || study->table() == nullptr || scene == nullptr || scene->table() == nullptr)
    throw InputError(folder + ": " + kStudyFile + " there is not a study written by butee");
  return read_study({known.sources, *study}, {known.sources, *scene}, {.horizon = [](scene::Scene&) { return 0.0; }});
}

std::string Store::extension_in(const std::string& folder) {
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const fs::path path = entry.path();
    if ((path.stem() == "study" || path.filename().string().starts_with("rows-")) && path.extension() != ".toml" &&
        path.extension() != ".part")
      return path.extension().string();
  }
  if (const std::string shard = study_in(folder); !shard.empty() && shard != folder) return extension_in(shard);
  throw InputError(folder + ": holds no rows yet");
}

}  // namespace butee::study
