#include "butee/record/result_folder.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "butee/core/bytes.hpp"
#include "butee/core/error.hpp"
#include "butee/record/file.hpp"
#include "butee/record/summary.hpp"

namespace butee::record {

namespace fs = std::filesystem;

namespace {

constexpr const char* kMark = "# butee: the model as run";
constexpr const char* kDraft = "model.toml.part";
constexpr const char* kOurFiles[] = {"history.csv",
                                     "impacts.csv",
                                     "wear.csv",
                                     "energy.csv",
                                     "fields.h5",
                                     "fields.xdmf",
                                     "summary.json",
                                     "checkpoint.bin",
                                     "checkpoint-before.bin",
                                     "checkpoint-next.bin",
                                     "checkpoint-next.bin.part",
                                     "summary.json.part",
                                     "states.bin"};

bool is_ours(const fs::path& folder) {
  std::ifstream model(folder / "model.toml");
  std::string first;
  return std::getline(model, first) && first == kMark;
}

/// The reason why a folder does not belong to butee; empty if it does, or if it is empty. A run
/// killed before model.toml was in its place leaves a draft of it and its lock.
std::string foreign_part(const fs::path& folder, std::error_code& error) {
  if (is_ours(folder)) return "";
  std::vector<std::string> found;
  fs::directory_iterator entry(folder, error);
  while (!error && entry != fs::directory_iterator()) {
    if (const std::string name = entry->path().filename().string(); name != kDraft && name != FolderLock::kName)
      found.push_back(name);
    entry.increment(error);
  }
  if (found.empty()) return "";
  std::sort(found.begin(), found.end());
  if (std::find(found.begin(), found.end(), "model.toml") != found.end())
    return "its model.toml does not begin with the line \"" + std::string(kMark) + "\"";
  return "it has no model.toml of a run, but " + found.front() +
         (found.size() > 1 ? " and " + std::to_string(found.size() - 1) + " more" : "");
}

}  // namespace

std::string ResultFolder::file(const std::string& name) const {
  return (fs::path(path_) / name).string();
}

std::string ResultFolder::read(const std::string& name) const {
  std::ifstream stream(file(name), std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::uint64_t ResultFolder::checksum_of(const std::string& name) const {
  const std::string text = read(name);
  return checksum(std::as_bytes(std::span(text)));
}

void ResultFolder::refuse_foreign() const {
  std::error_code error;
  const fs::file_status status = fs::status(path_, error);
  if (!fs::exists(status)) return;
  if (!fs::is_directory(status))
    throw InputError(path_ + ": is a file, not a folder for results; choose another with -o");
  const std::string foreign = foreign_part(path_, error);
  if (error) throw InputError(path_ + ": cannot be read: " + error.message());
  if (!foreign.empty())
    throw InputError(path_ + ": is not empty and holds no results of butee (" + foreign +
                     "), so it is not touched; choose another folder with -o");
}

void ResultFolder::check() const {
  refuse_foreign();
  FolderLock::check(path_);
}

void ResultFolder::check_holds_no_run() const {
  check();
  std::error_code error;
  for (const char* name : kOurFiles)
    if (fs::exists(file(name), error))
      throw InputError(path_ + ": holds the results of a run (" + name + "); choose another folder with -o");
}

FolderLock ResultFolder::lock() const {
  std::error_code error;
  fs::create_directories(path_, error);
  if (error) throw RunError(path_ + ": cannot be created: " + error.message());
  FolderLock lock(path_);
  refuse_foreign();
  return lock;
}

void ResultFolder::check_is_ours() const {
  if (is_ours(path_)) return;
  std::error_code error;
  if (!fs::exists(path_, error)) throw InputError(path_ + ": does not exist");
  const std::string foreign = foreign_part(path_, error);
  throw InputError(path_ + ": contains no results of butee from which a run could resume" +
                   (foreign.empty() ? "" : " (" + foreign + ")"));
}

bool ResultFolder::is_complete() const {
  return is_completed(read("summary.json"));
}

void ResultFolder::prepare(const std::string& model_text) const {
  std::error_code error;
  for (const char* name : kOurFiles) fs::remove(file(name), error);
  write("model.toml", std::string(kMark) + "\n" + model_text);
}

void ResultFolder::write(const std::string& name, const std::string& text) const {
  write_whole(file(name), std::as_bytes(std::span(text)));
}

}  // namespace butee::record
