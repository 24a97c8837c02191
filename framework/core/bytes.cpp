#include "butee/core/bytes.hpp"

#include <array>

#include "butee/core/error.hpp"

namespace butee {

void ByteWriter::append(const void* from, std::size_t size) {
  const auto* first = static_cast<const std::byte*>(from);
  bytes_.insert(bytes_.end(), first, first + size);
}

void ByteWriter::put(std::span<const double> numbers) {
  put(std::uint64_t{numbers.size()});
  append(numbers.data(), numbers.size_bytes());
}

void ByteWriter::put(const std::string& text) {
  put(std::uint64_t{text.size()});
  append(text.data(), text.size());
}

void ByteWriter::put(std::span<const std::byte> bytes) {
  put(std::uint64_t{bytes.size()});
  append(bytes.data(), bytes.size());
}

const std::byte* ByteReader::next(std::size_t count, std::size_t size) {
  if (count > rest_.size() / size) throw RunError("the data end too early");
  const std::byte* first = rest_.data();
  rest_ = rest_.subspan(count * size);
  return first;
}

std::size_t ByteReader::count(std::size_t size) {
  const auto number = take<std::uint64_t>();
  if (number > rest_.size() / size) throw RunError("the data end too early");
  return static_cast<std::size_t>(number);
}

void ByteReader::take(Vector& numbers) {
  const std::size_t size = count(sizeof(double));
  numbers.resize(static_cast<Index>(size));
  if (size > 0) std::memcpy(numbers.data(), next(size, sizeof(double)), size * sizeof(double));
}

void ByteReader::take(std::vector<double>& numbers) {
  numbers.resize(count(sizeof(double)));
  if (!numbers.empty())
    std::memcpy(numbers.data(), next(numbers.size(), sizeof(double)), numbers.size() * sizeof(double));
}

void ByteReader::take(std::string& text) {
  const std::size_t size = count();
  text.assign(reinterpret_cast<const char*>(next(size, 1)), size);
}

void ByteReader::take(std::vector<std::byte>& bytes) {
  const std::size_t size = count();
  const std::byte* first = next(size, 1);
  bytes.assign(first, first + size);
}

std::uint64_t checksum(std::span<const std::byte> bytes) {
  constexpr std::uint64_t kReversed = 0xC96C5795D7870F42U;
  static constexpr auto kTable = [] {
    std::array<std::uint64_t, 256> table{};
    for (std::size_t i = 0; i < table.size(); ++i) {
      std::uint64_t entry = i;
      for (int bit = 0; bit < 8; ++bit) entry = (entry & 1U) != 0 ? (entry >> 1U) ^ kReversed : entry >> 1U;
      table[i] = entry;
    }
    return table;
  }();
  std::uint64_t sum = ~std::uint64_t{0};
  for (const std::byte byte : bytes) sum = kTable[(sum ^ static_cast<std::uint64_t>(byte)) & 0xFFU] ^ (sum >> 8U);
  return ~sum;
}

}  // namespace butee
