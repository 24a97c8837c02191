#include "butee/study/store.hpp"

#include <algorithm>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <map>

#include "butee/config/file_reference.hpp"
#include "butee/config/toml.hpp"
#include "butee/core/error.hpp"
#include "butee/core/log.hpp"
#include "butee/core/text.hpp"
#include "butee/record/file.hpp"

namespace butee::study {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

constexpr const char *kMark = "# butee: the study as run", *kStudyFile = Store::kStudyFile, *kRows = "rows-",
                     *kSweep = Store::kSweep, *kShard = "shard-", *kResult = "study";
/// Rows are written after this time, or when this number of bytes is waiting.
constexpr auto kPatience = 200ms;
constexpr std::size_t kMostWaiting = std::size_t{1} << 20U;

bool begins_with(const std::string& text, const std::string& begin) {
  return text.rfind(begin, 0) == 0;
}

std::vector<std::string> entries_of(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error); !error && entry != fs::directory_iterator(); entry.increment(error))
    names.push_back(entry->path().filename().string());
  if (error) throw InputError(folder + ": cannot be read: " + error.message());
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<std::string> shards_in(const std::string& folder) {
  std::vector<std::string> shards;
  for (const std::string& name : entries_of(folder))
    if (begins_with(name, kShard) && Store::is_study_folder((fs::path(folder) / name).string()))
      shards.push_back((fs::path(folder) / name).string());
  return shards;
}

/// A file that a study leaves if it is killed before study.toml is in its place.
bool is_draft(const std::string& name) {
  return name == record::FolderLock::kName || name == std::string(kStudyFile) + ".part";
}

/// A shard of a study, also one that was killed at its start; not any other folder of such a name.
bool is_shard(const std::string& folder, const std::string& name) {
  const std::string path = (fs::path(folder) / name).string();
  if (!begins_with(name, kShard) || !fs::is_directory(path)) return false;
  const auto entries = entries_of(path);
  return Store::is_study_folder(path) || std::all_of(entries.begin(), entries.end(), is_draft);
}

/// The tables of a study, with absolute paths of point files.
config::Value with_absolute_files(const config::Document& document) {
  config::Value root = document.root;
  if (const config::Value* list = root.table()->find("vary"); list != nullptr && list->array() != nullptr)
    for (config::Value& axis : std::get<config::Array>((*root.table())["vary"].data))
      if (axis.table() != nullptr && axis.table()->find("file") != nullptr) {
        config::Value& file = (*axis.table())["file"];
        if (file.text() != nullptr)
          file = config::Value(fs::absolute(config::path_beside(document, *file.text())).string());
      }
  return root;
}

}  // namespace

Store::Store(std::string folder, const Study& study, const Layout& layout, RowFormat& format)
    : folder_(std::move(folder)), study_(study), layout_(layout), format_(format), identity_(identity_of(study)) {}

Store::~Store() = default;

bool Store::is_study_folder(const std::string& folder) {
  std::ifstream file(fs::path(folder) / kStudyFile);
  std::string first;
  return std::getline(file, first) && first == kMark;
}

std::string Store::study_in(const std::string& folder) {
  if (is_study_folder(folder) || !fs::is_directory(folder)) return is_study_folder(folder) ? folder : "";
  const std::vector<std::string> shards = shards_in(folder);
  return shards.empty() ? "" : shards.front();
}

std::string Store::file(const std::string& name) const {
  return (fs::path(folder_) / name).string();
}

std::string Store::result() const {
  return file(kResult + format_.extension());
}

bool Store::is_row_file(const std::string& name) {
  const fs::path path = name;
  return (path.stem() == kResult || begins_with(name, kRows)) && name != kStudyFile && path.extension() != ".part";
}

std::vector<std::string> Store::row_files(const std::string& folder) const {
  std::vector<std::string> files;
  for (const std::string& name : entries_of(folder)) {
    const fs::path path = fs::path(folder) / name;
    if (!is_row_file(name)) continue;
    if (path.extension() == format_.extension() && begins_with(name, kRows)) files.push_back(path.string());
    if (path.extension() != format_.extension())
      throw InputError(folder + ": the existing study has its rows in " + name + ", but the requested format is " +
                       format_.extension() + "; use the --format of the existing study, or --fresh");
  }
  return files;
}

void Store::refuse_foreign(const std::string& folder) {
  if (!fs::exists(folder)) return;
  if (!fs::is_directory(folder))
    throw InputError(folder + ": is a file, not a folder for results; choose another with -o");
  if (is_study_folder(folder)) return;
  for (const std::string& name : entries_of(folder))
    if (!is_draft(name) && !is_shard(folder, name))
      throw InputError(folder + ": is not empty and holds no study of butee (it has " + name +
                       "), so it is not touched; choose another folder with -o");
}

void Store::clear() const {
  std::error_code error;
  for (const std::string& name : entries_of(folder_))
    if (begins_with(name, kRows) || begins_with(name, kSweep) || is_shard(folder_, name) ||
        begins_with(name, std::string(kResult) + "."))
      fs::remove_all(fs::path(folder_) / name, error);
}

void Store::open(bool fresh) {
  refuse_foreign(folder_);
  if (fs::exists(folder_)) record::FolderLock::check(folder_);
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error) throw RunError(folder_ + ": cannot be created: " + error.message() + "; choose another folder with -o");
  try {
    lock_ = std::make_unique<record::FolderLock>(folder_);
  } catch (const RunError& cause) {
    throw InputError(std::string(cause.what()) + "; choose another folder with -o");
  }
  refuse_foreign(folder_);
  for (const std::string& shard : shards_in(folder_)) record::FolderLock::check(shard);
  if (fresh) clear();
  if (!fresh && is_study_folder(folder_)) {
    check_identity(folder_);
  } else {
    config::Table root, identity;
    for (const auto& [key, text] :
         {std::pair("study", identity_.study), {"scene", identity_.scene}, {"build", identity_.build}})
      identity[key] = config::Value(text);
    root["identity"] = config::Value(std::move(identity));
    root["study"] = with_absolute_files(study_.document);
    root["scene"] = study_.scene.root;
    const std::string text = std::string(kMark) + "\n" + config::write_toml(root);
    record::write_whole(file(kStudyFile), std::as_bytes(std::span(text)));
  }
  look();
}

void Store::look() {
  done_.assign(static_cast<std::size_t>(study_.plan.run_count()), false);
  done_count_ = 0;
  is_complete_ = fs::exists(result());
  next_session_ = 0;
  read_done();
}

std::unique_ptr<RowSource> Store::open_rows(const std::string& path) const {
  // A lack of rights or of descriptors does not damage rows.
  record::File(path, O_RDONLY);
  try {
    return format_.open(path, layout_);
  } catch (const RunError& error) {
    log::warning(std::string(error.what()) + "; its rows are computed again");
    return nullptr;
  }
}

void Store::read_done() {
  if (!is_complete_)
    for (const std::string& name : row_files(folder_)) {
      const int session = std::atoi(fs::path(name).filename().c_str() + std::string(kRows).size());
      next_session_ = std::max(next_session_, session + 1);
    }
  visit_files(is_complete_ ? std::vector{result()} : all_row_files(), [&](std::size_t, std::int64_t, std::int64_t run) {
    if (done_[static_cast<std::size_t>(run)]) return;
    done_[static_cast<std::size_t>(run)] = true;
    ++done_count_;
  });
  if (is_complete_ && done_count_ != std::ssize(done_))
    throw RunError(result() + ": does not hold all rows; use --fresh to start again");
}

void Store::begin(int session, int process) {
  sink_ = format_.create(file(kRows + std::to_string(session) + "-" + std::to_string(process) + format_.extension()),
                         layout_, study_.title);
  flushed_ = std::chrono::steady_clock::now();
}

void Store::append(const Row& row) {
  const std::lock_guard guard(mutex_);
  waiting_.insert(waiting_.end(), row.bytes().begin(), row.bytes().end());
  const auto now = std::chrono::steady_clock::now();
  if (now - flushed_ < kPatience && waiting_.size() < kMostWaiting) return;
  sink_->append(waiting_);
  waiting_.clear();
  flushed_ = now;
}

void Store::flush() {
  const std::lock_guard guard(mutex_);
  if (!waiting_.empty()) sink_->append(waiting_);
  waiting_.clear();
  flushed_ = std::chrono::steady_clock::now();
}

std::vector<std::string> Store::all_row_files() const {
  std::vector<std::string> files = row_files(folder_);
  for (const std::string& shard : shards_in(folder_)) {
    check_identity(shard);
    const auto more = row_files(shard);
    files.insert(files.end(), more.begin(), more.end());
  }
  return files;
}

void Store::remove_parts() const {
  std::error_code error;
  for (const std::string& shard : shards_in(folder_)) fs::remove_all(shard, error);
  for (const std::string& name : entries_of(folder_))
    if (begins_with(name, kSweep)) fs::remove(file(name), error);
}

Store::Count Store::count() const {
  Count count;
  const std::size_t status = layout_.find(kStatusColumn), reason = layout_.find(kReasonColumn);
  visit([&](const Row& row) {
    if (row.text(status) == "completed") {
      ++count.completed;
      return;
    }
    if (count.failed++ == 0) count.first_reason = row.text(reason);
  });
  return count;
}

}  // namespace butee::study
