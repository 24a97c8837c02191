#pragma once

#include <hdf5.h>
#include <string>
#include <utility>
#include <vector>

namespace butee::plugins::hdf5 {

/// Owns an object of the HDF5 library.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);

  Handle() = default;
  /// Throws RunError ("cannot <what>: <the library's reason>") if `id` indicates a failed call.
  Handle(hid_t id, Close close, const std::string& what);
  ~Handle() { reset(); }
  Handle(Handle&& other) noexcept
      : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(std::exchange(other.close_, nullptr)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }

  operator hid_t() const { return id_; }
  /// Leaves the object open for good.
  void abandon() { close_ = nullptr; }
  /// Closes the object; false if that failed.
  bool reset() { return close_ == nullptr || std::exchange(close_, nullptr)(std::exchange(id_, H5I_INVALID_HID)) >= 0; }

 private:
  hid_t id_ = H5I_INVALID_HID;
  Close close_ = nullptr;
};

/// Throws RunError if a call of the library failed.
void check(herr_t status, const std::string& what);

/// Turns off the library's own messages on standard error.
void be_silent();

using Sizes = std::vector<hsize_t>;

/// Creates and writes a whole dataset of numbers.
void write_numbers(hid_t file, const std::string& path, const Sizes& size, hid_t memory_type, hid_t file_type,
                   const void* values);
/// Creates and writes a dataset of texts of equal length, padded with zeros.
void write_texts(hid_t file, const std::string& path, const std::vector<std::string>& texts);
void write_attribute(hid_t object, const std::string& name, const std::string& text);

Sizes size_of(hid_t dataset);
std::vector<double> read_numbers(hid_t file, const std::string& path);
std::vector<std::string> read_texts(hid_t file, const std::string& path);
/// Empty if there is no such attribute.
std::string read_attribute(hid_t object, const std::string& name);

}  // namespace butee::plugins::hdf5
