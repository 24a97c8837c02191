#include "butee/record/result_folder.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "butee/core/error.hpp"

namespace butee::record {

namespace fs = std::filesystem;

namespace {

constexpr const char* kMark = "# butee: the model as run";
constexpr const char* kOurFiles[] = {"history.csv", "impacts.csv", "summary.json"};

bool is_ours(const fs::path& folder) {
  std::ifstream model(folder / "model.toml");
  std::string first;
  return std::getline(model, first) && first == kMark;
}

}  // namespace

std::string ResultFolder::file(const std::string& name) const {
  return (fs::path(path_) / name).string();
}

void ResultFolder::check() const {
  std::error_code error;
  const fs::file_status status = fs::status(path_, error);
  if (!fs::exists(status)) return;
  if (!fs::is_directory(status))
    throw InputError(path_ + ": is a file, not a folder for results; choose another with -o");
  const bool empty = fs::is_empty(path_, error);
  if (error) throw InputError(path_ + ": cannot be read: " + error.message());
  if (!empty && !is_ours(path_))
    throw InputError(
        path_ + ": is not empty and holds no results of butee, so it is left alone; choose another folder with -o");
}

void ResultFolder::prepare(const std::string& model_text) const {
  std::error_code error;
  fs::create_directories(path_, error);
  if (error) throw RunError(path_ + ": cannot be made: " + error.message());
  for (const char* name : kOurFiles) fs::remove(file(name), error);
  write("model.toml", std::string(kMark) + "\n" + model_text);
}

void ResultFolder::write(const std::string& name, const std::string& text) const {
  const std::string target = file(name), draft = target + ".part";
  {
    std::ofstream stream(draft, std::ios::binary);
    stream << text;
    stream.close();
    if (!stream) throw RunError(target + ": cannot be written: " + std::strerror(errno));
  }
  std::error_code error;
  fs::rename(draft, target, error);
  if (error) throw RunError(target + ": cannot be written: " + error.message());
}

}  // namespace butee::record
