#include "butee/config/file_reference.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <string_view>

#include "butee/core/bytes.hpp"
#include "butee/core/error.hpp"
#include "butee/core/types.hpp"

namespace butee::config {

namespace fs = std::filesystem;

namespace {

constexpr std::uintmax_t kLargestFile = std::uintmax_t{1} << 31U;
/// The file of a result folder to which [initial] from refers.
constexpr const char* kStates = "states.bin";

std::string found_from(const Document& document, const std::string& file, const std::string& folder) {
  if (fs::path(file).is_absolute()) return file;
  const fs::path whole = fs::weakly_canonical(fs::absolute(path_beside(document, file)));
  return whole.lexically_proximate(fs::weakly_canonical(fs::absolute(folder))).generic_string();
}

void pin(const Document& document, Table& table, const char* key, const char* inner, const std::string& folder) {
  const Value* named = table.find(key);
  if (named == nullptr || named->text() == nullptr) return;
  const std::string file = *named->text();
  const std::string path = path_beside(document, file);
  const std::string bytes = read_text(*inner != '\0' ? (fs::path(path) / inner).string() : path);
  table[key] = Value(found_from(document, file, folder));
  table["size"] = Value(std::int64_t{std::ssize(bytes)});
  table["checksum"] = Value(checksum_text(bytes));
}

bool is_table_of_file(const Table& table) {
  const Value *type = table.find("type"), *file = table.find("file");
  return type != nullptr && type->text() != nullptr && *type->text() == "table" && file != nullptr;
}

bool is_element_of_files(const Table& table) {
  const Value *type = table.find("type"), *mass = table.find("mass");
  return type != nullptr && type->text() != nullptr && *type->text() == "matrices" && mass != nullptr &&
         mass->text() != nullptr;
}

/// A text, or the text in an array of one.
const std::string* single_text(const Value* value) {
  if (value == nullptr) return nullptr;
  const Array* array = value->array();
  return array != nullptr && array->size() == 1 ? array->front().text() : value->text();
}

/// The files of [[element]] type = "matrices"; `dofs` may be a degree of freedom instead of a file.
void pin_matrices(const Document& document, Table& table, const std::string& folder) {
  Array checksums;
  for (const char* key : {"mass", "stiffness", "damping", "gyroscopic", "dofs"}) {
    const std::string* named = single_text(table.find(key));
    if (named == nullptr || dof_named(*named)) continue;
    const std::string file = *named;
    checksums.emplace_back(checksum_text(read_text(path_beside(document, file))));
    table[key] = Value(found_from(document, file, folder));
  }
  table["checksums"] = Value(std::move(checksums));
}

void pin_all(const Document& document, Value& value, const std::string& folder) {
  if (Array* array = value.array())
    for (Value& item : *array) pin_all(document, item, folder);
  Table* table = value.table();
  if (table == nullptr) return;
  for (auto& entry : table->entries) pin_all(document, entry.second, folder);
  if (is_table_of_file(*table)) pin(document, *table, "file", "", folder);
  if (is_element_of_files(*table)) pin_matrices(document, *table, folder);
}

void erase(Table& table, std::initializer_list<std::string_view> keys) {
  std::erase_if(table.entries, [&](const Table::Entry& entry) {
    return std::find(keys.begin(), keys.end(), entry.first) != keys.end();
  });
}

void take_files_out(Value& value) {
  if (Array* array = value.array())
    for (Value& item : *array) take_files_out(item);
  Table* table = value.table();
  if (table == nullptr) return;
  for (auto& entry : table->entries) take_files_out(entry.second);
  if (!is_table_of_file(*table)) return;
  erase(*table, {"file", "columns", "skip", "scale", "size", "checksum"});
  for (const char* key : {"times", "values"}) (*table)[key] = Value(Array{Value(0.0)});
}

}  // namespace

Document without_files(Document document) {
  take_files_out(document.root);
  if (Value* initial = document.root.table()->find("initial"); initial != nullptr && initial->table() != nullptr)
    erase(*initial->table(), {"from", "at", "keep_time", "size", "checksum"});
  return document;
}

std::string path_beside(const Document& document, const std::string& file) {
  return (fs::path(document.sources.front()).parent_path() / file).string();
}

std::string read_text(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) throw InputError("does not exist");
  if (fs::is_directory(status)) throw InputError("is a folder, not a file");
  if (!fs::is_regular_file(status)) throw InputError("is not a regular file");
  const std::uintmax_t size = fs::file_size(path, error);
  if (!error && size > kLargestFile) throw InputError("is larger than " + std::to_string(kLargestFile >> 30U) + " GiB");
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  std::string text(error ? 0 : size, '\0');
  if (error || !file.read(text.data(), std::ssize(text)))
    throw InputError(std::string("cannot be read: ") + (errno != 0 ? std::strerror(errno) : "it became shorter"));
  return text;
}

std::string checksum_text(const std::string& bytes) {
  std::array<char, 17> text{};
  std::snprintf(text.data(), text.size(), "%016llx",
                static_cast<unsigned long long>(checksum(std::as_bytes(std::span(bytes)))));
  return text.data();
}

Table with_files_found_from(const Document& document, const std::string& folder) {
  Value root = document.root;
  pin_all(document, root, folder);
  if (Value* initial = root.table()->find("initial"); initial != nullptr && initial->table() != nullptr)
    pin(document, *initial->table(), "from", kStates, folder);
  return std::move(*root.table());
}

std::string change_of(const std::string& bytes, std::int64_t size, const std::string& checksum) {
  const bool other_size = size > 0 && std::ssize(bytes) != size;
  if (!other_size && (checksum.empty() || checksum_text(bytes) == checksum)) return "";
  return "is not the file that the model was run with: it has " + std::to_string(bytes.size()) +
         " bytes and the checksum " + checksum_text(bytes) + (size > 0 ? ", not " + std::to_string(size) : ", not") +
         (checksum.empty() ? "" : (size > 0 ? " and " : " ") + checksum) +
         "; put the old file back, or remove size and checksum";
}

}  // namespace butee::config
