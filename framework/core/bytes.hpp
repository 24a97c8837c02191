#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include <butee/export.hpp>

#include "butee/core/types.hpp"

namespace butee {

/// Appends numbers, vectors and texts to an array of bytes, in this machine's own representation:
/// readable bit for bit by the same build on the same kind of machine.
class BUTEE_EXPORT ByteWriter {
 public:
  /// `bytes` is cleared and its memory reused. It must outlive the writer.
  explicit ByteWriter(std::vector<std::byte>& bytes) : bytes_(bytes) { bytes_.clear(); }

  template <class Number>
  requires std::is_arithmetic_v<Number>
  void put(Number number) { append(&number, sizeof number); }
  void put(std::span<const double> numbers);
  void put(const Vector& numbers) { put(std::span(numbers.data(), static_cast<std::size_t>(numbers.size()))); }
  void put(const std::vector<double>& numbers) { put(std::span<const double>(numbers)); }
  void put(const std::string& text);
  void put(std::span<const std::byte> bytes);

 private:
  void append(const void* from, std::size_t size);

  std::vector<std::byte>& bytes_;
};

/// Reads data written by a ByteWriter, in the same order. Throws RunError if the bytes end too
/// early.
class BUTEE_EXPORT ByteReader {
 public:
  /// `bytes` must outlive this object.
  explicit ByteReader(std::span<const std::byte> bytes) : rest_(bytes) {}

  template <class Number>
  requires std::is_arithmetic_v<Number>
  void take(Number& number) {
    if constexpr (std::is_same_v<Number, bool>) {
      std::uint8_t byte = 0;
      take(byte);
      number = byte != 0;
    } else {
      std::memcpy(&number, next(1, sizeof number), sizeof number);
    }
  }
  void take(Vector& numbers);
  void take(std::vector<double>& numbers);
  void take(std::string& text);
  void take(std::vector<std::byte>& bytes);
  template <class Number>
  Number take() {
    Number number{};
    take(number);
    return number;
  }

  /// Reads the number of following items, each of at least `size` bytes; never more than the
  /// remaining bytes allow.
  std::size_t count(std::size_t size = 1);
  bool at_end() const { return rest_.empty(); }

 private:
  const std::byte* next(std::size_t count, std::size_t size);

  std::span<const std::byte> rest_;
};

/// CRC-64/XZ: detects accidental damage, not forgery.
BUTEE_EXPORT std::uint64_t checksum(std::span<const std::byte> bytes);

}  // namespace butee
