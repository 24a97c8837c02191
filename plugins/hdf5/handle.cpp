#include "handle.hpp"

#include <algorithm>

#include <butee/core/error.hpp>
#include <butee/plugin/entry.hpp>

namespace butee::plugins::hdf5 {
namespace {

/// The innermost error message of the library.
std::string reason() {
  std::string text;
  H5Ewalk2(
      H5E_DEFAULT, H5E_WALK_UPWARD,
      [](unsigned depth, const H5E_error2_t* error, void* to) -> herr_t {
        if (depth == 0 && error->desc != nullptr) *static_cast<std::string*>(to) = error->desc;
        return 0;
      },
      &text);
  // Errors of the operating system contain its message within a long line.
  const std::string mark = "error message = '";
  if (const auto begin = text.find(mark); begin != std::string::npos)
    text = text.substr(begin + mark.size(), text.find('\'', begin + mark.size()) - begin - mark.size());
  return text.empty() ? "no reason given" : text;
}

Handle text_type(std::size_t length) {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "make a type of text");
  check(H5Tset_size(type, std::max<std::size_t>(length, 1)), "make a type of text");
  check(H5Tset_strpad(type, H5T_STR_NULLPAD), "make a type of text");
  check(H5Tset_cset(type, H5T_CSET_UTF8), "make a type of text");
  return type;
}

Handle open_dataset(hid_t file, const std::string& path) {
  return {H5Dopen2(file, path.c_str(), H5P_DEFAULT), H5Dclose, "read " + path};
}

}  // namespace

Handle::Handle(hid_t id, Close close, const std::string& what) : id_(id), close_(close) {
  if (id_ >= 0) return;
  close_ = nullptr;
  throw RunError("HDF5 cannot " + what + ": " + reason());
}

void check(herr_t status, const std::string& what) {
  if (status < 0) throw RunError("HDF5 cannot " + what + ": " + reason());
}

void be_silent() {
  // At the exit of the program the library would close files again that a full disk has kept open, and crash. A host
  // that uses HDF5 itself has to close its files.
  H5dont_atexit();
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

void write_numbers(hid_t file, const std::string& path, const Sizes& size, hid_t memory_type, hid_t file_type,
                   const void* values) {
  const Handle space(H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr), H5Sclose, "make " + path);
  const Handle set(H5Dcreate2(file, path.c_str(), file_type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose,
                   "make " + path);
  if (values != nullptr) check(H5Dwrite(set, memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), "write " + path);
}

void write_texts(hid_t file, const std::string& path, const std::vector<std::string>& texts) {
  std::size_t length = 1;
  for (const std::string& text : texts) length = std::max(length, text.size());
  std::string all;
  for (const std::string& text : texts) all += text + std::string(length - text.size(), '\0');
  const Handle type = text_type(length);
  write_numbers(file, path, {texts.size()}, type, type, texts.empty() ? nullptr : all.data());
}

void write_attribute(hid_t object, const std::string& name, const std::string& text) {
  const Handle type = text_type(text.size());
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose, "make " + name);
  const Handle attribute(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                         "make " + name);
  const std::string padded = text.empty() ? std::string(1, '\0') : text;
  check(H5Awrite(attribute, type, padded.data()), "write " + name);
}

Sizes size_of(hid_t dataset) {
  const Handle space(H5Dget_space(dataset), H5Sclose, "read a dataset's size");
  Sizes size(static_cast<std::size_t>(std::max(0, H5Sget_simple_extent_ndims(space))));
  check(H5Sget_simple_extent_dims(space, size.data(), nullptr), "read a dataset's size");
  return size;
}

std::vector<double> read_numbers(hid_t file, const std::string& path) {
  const Handle set = open_dataset(file, path);
  hsize_t count = 1;
  for (const hsize_t n : size_of(set)) count *= n;
  std::vector<double> values(count);
  if (count > 0) check(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), "read " + path);
  return values;
}

std::vector<std::string> read_texts(hid_t file, const std::string& path) {
  const Handle set = open_dataset(file, path), type(H5Dget_type(set), H5Tclose, "read " + path);
  const Sizes size = size_of(set);
  const std::size_t count = size.empty() ? 0 : size[0], length = H5Tget_size(type);
  std::string all(count * length, '\0');
  if (count > 0) check(H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, all.data()), "read " + path);
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < count; ++i) texts.emplace_back(all.substr(i * length, length).c_str());
  return texts;
}

std::string read_attribute(hid_t object, const std::string& name) {
  if (H5Aexists(object, name.c_str()) <= 0) return "";
  const Handle attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose, "read " + name);
  const Handle type(H5Aget_type(attribute), H5Tclose, "read " + name);
  if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) > 0) return "";
  std::string text(H5Tget_size(type), '\0');
  check(H5Aread(attribute, type, text.data()), "read " + name);
  return text.c_str();
}

}  // namespace butee::plugins::hdf5
