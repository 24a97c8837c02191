#include "butee/record/result_folder.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>

#include "butee/core/bytes.hpp"
#include "butee/core/error.hpp"
#include "butee/record/file.hpp"

namespace butee::record {

namespace fs = std::filesystem;

namespace {

constexpr const char* kMark = "# butee: the model as run";
constexpr const char* kDraft = "model.toml.part";
constexpr const char* kOurFiles[] = {"history.csv",         "impacts.csv",
                                     "energy.csv",          "fields.h5",
                                     "fields.xdmf",         "summary.json",
                                     "checkpoint.bin",      "checkpoint-before.bin",
                                     "checkpoint-next.bin", "checkpoint-next.bin.part",
                                     "summary.json.part",   "states.bin"};

bool is_ours(const fs::path& folder) {
  std::ifstream model(folder / "model.toml");
  std::string first;
  return std::getline(model, first) && first == kMark;
}

/// A run that was killed before model.toml was in its place leaves the draft of it, and nothing else.
bool holds_nothing(const fs::path& folder, std::error_code& error) {
  fs::directory_iterator entry(folder, error);
  while (!error && entry != fs::directory_iterator()) {
    if (entry->path().filename() != kDraft) return false;
    entry.increment(error);
  }
  return true;
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

void ResultFolder::check() const {
  std::error_code error;
  const fs::file_status status = fs::status(path_, error);
  if (!fs::exists(status)) return;
  if (!fs::is_directory(status))
    throw InputError(path_ + ": is a file, not a folder for results; choose another with -o");
  const bool empty = holds_nothing(path_, error);
  if (error) throw InputError(path_ + ": cannot be read: " + error.message());
  if (!empty && !is_ours(path_))
    throw InputError(
        path_ + ": is not empty and holds no results of butee, so it is left alone; choose another folder with -o");
}

void ResultFolder::check_is_ours() const {
  if (!is_ours(path_)) throw InputError(path_ + ": holds no results of butee that a run could go on from");
}

bool ResultFolder::is_complete() const {
  return read("summary.json").find("\"status\": \"completed\"") != std::string::npos;
}

void ResultFolder::prepare(const std::string& model_text) const {
  std::error_code error;
  fs::create_directories(path_, error);
  if (error) throw RunError(path_ + ": cannot be made: " + error.message());
  for (const char* name : kOurFiles) fs::remove(file(name), error);
  write("model.toml", std::string(kMark) + "\n" + model_text);
}

void ResultFolder::write(const std::string& name, const std::string& text) const {
  write_whole(file(name), std::as_bytes(std::span(text)));
}

}  // namespace butee::record
