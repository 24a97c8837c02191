#include <algorithm>
#include <filesystem>

#include "butee/config/toml.hpp"
#include "butee/core/error.hpp"
#include "butee/record/file.hpp"
#include "butee/study/store.hpp"

namespace butee::study {

namespace fs = std::filesystem;

namespace {

/// Number of bytes of rows that are put in order at once.
constexpr std::size_t kGathered = std::size_t{1} << 26U;

}  // namespace

struct Store::Found {
  struct Place {
    std::int32_t file = -1;
    std::int64_t index = 0;
  };
  std::vector<std::string> files;
  std::vector<Place> places;  ///< by run
};

Store::Found Store::find_rows() const {
  Found found;
  found.files = all_row_files();
  found.places.resize(static_cast<std::size_t>(study_.plan.run_count()));
  visit_files(found.files, [&](std::size_t file, std::int64_t i, std::int64_t run) {
    Found::Place& place = found.places[static_cast<std::size_t>(run)];
    if (place.file < 0) place = {static_cast<std::int32_t>(file), i};
  });
  return found;
}

void Store::visit_files(const std::vector<std::string>& files,
                        const std::function<void(std::size_t file, std::int64_t index, std::int64_t run)>& look) const {
  std::vector<std::byte> bytes(layout_.row_bytes());
  const std::size_t run_column = layout_.find(kRunColumn);
  for (std::size_t file = 0; file < files.size(); ++file) {
    const auto source = is_complete_ ? format_.open(files[file], layout_) : open_rows(files[file]);
    for (std::int64_t i = 0; source != nullptr && i < source->size(); ++i) {
      if (!source->read(i, bytes)) continue;
      const std::int64_t run = Row(layout_, bytes).integer(run_column);
      if (run < 0 || run >= study_.plan.run_count())
        throw RunError(files[file] + ": contains a row that belongs to no run of this study");
      look(file, i, run);
    }
  }
}

void Store::visit_in_order(const Found& found, const std::function<void(std::span<const std::byte> rows)>& look) const {
  struct Wanted {
    Found::Place place;
    std::size_t slot;
  };
  const std::size_t row_bytes = layout_.row_bytes(), most = std::max<std::size_t>(1, kGathered / row_bytes);
  std::vector<std::byte> rows;
  std::vector<Wanted> wanted;
  const auto gather = [&] {
    rows.resize(wanted.size() * row_bytes);
    std::sort(wanted.begin(), wanted.end(), [](const Wanted& a, const Wanted& b) {
      return std::pair(a.place.file, a.place.index) < std::pair(b.place.file, b.place.index);
    });
    // One file at a time is open: a study may have more of them than a process may open.
    std::unique_ptr<RowSource> source;
    std::int32_t open = -1;
    for (const Wanted& one : wanted) {
      const std::string& path = found.files[static_cast<std::size_t>(one.place.file)];
      if (open != one.place.file) source = format_.open(path, layout_);
      open = one.place.file;
      if (!source->read(one.place.index, std::span(rows).subspan(one.slot * row_bytes, row_bytes)))
        throw RunError(path + ": a row that was there cannot be read any more");
    }
    look(rows);
    wanted.clear();
  };
  for (const Found::Place& place : found.places) {
    if (place.file < 0) continue;
    wanted.push_back({place, wanted.size()});
    if (wanted.size() == most) gather();
  }
  if (!wanted.empty()) gather();
}

bool Store::merge(std::int64_t& missing) {
  if (sink_) {
    flush();
    sink_->close();
    sink_.reset();
  }
  if (is_complete_) return true;
  const Found found = find_rows();
  const auto absent =
      std::find_if(found.places.begin(), found.places.end(), [](const Found::Place& place) { return place.file < 0; });
  if (absent != found.places.end()) {
    missing = absent - found.places.begin();
    return false;
  }
  const std::string draft = result() + ".part";
  const auto sink = format_.create(draft, layout_, study_.title);
  visit_in_order(found, [&](std::span<const std::byte> rows) { sink->append(rows); });
  sink->close();
  record::put_in_place(draft, result());
  std::error_code error;
  for (const std::string& path : found.files) fs::remove(path, error);
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
  visit_in_order(find_rows(), [&](std::span<const std::byte> rows) {
    for (; !rows.empty(); rows = rows.subspan(layout_.row_bytes())) look(Row(layout_, rows.first(layout_.row_bytes())));
  });
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
    if (is_row_file(path.filename().string())) return path.extension().string();
  }
  if (const std::string shard = study_in(folder); !shard.empty() && shard != folder) return extension_in(shard);
  throw InputError(folder + ": holds no rows yet");
}

}  // namespace butee::study
