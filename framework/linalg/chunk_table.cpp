#include "butee/linalg/chunk_table.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <unordered_map>

#include "butee/core/zeros.hpp"

namespace butee::linalg {
namespace {

/// This number of doubles stays in the nearest cache.
constexpr Index kFew = Index{1} << 13U;
/// Sharing is abandoned if more chunks than kDifferent plus 1/kPart of all chunks so far are
/// different.
constexpr Index kDifferent = 256, kPart = 8;

/// Multiplication and rotation of each double's bits; hash collisions are resolved by comparison.
std::uint64_t hash_of(const double* chunk, Index width) {
  constexpr std::uint64_t kOdd = 0x9e3779b97f4a7c15U;
  std::uint64_t hash = 0;
  for (Index i = 0; i < width; ++i) hash = std::rotl((hash ^ std::bit_cast<std::uint64_t>(chunk[i])) * kOdd, 29);
  return hash;
}

}  // namespace

ChunkTable::ChunkTable(Index width, Index count) : width_(width), place_(static_cast<std::size_t>(count)) {
  place_apart();
}

void ChunkTable::place_apart() {
  data_ = zeros(width_ * static_cast<Index>(place_.size()));
  for (std::size_t i = 0; i < place_.size(); ++i) place_[i] = width_ * static_cast<Index>(i);
}

double* ChunkTable::write() {
  if (is_shared()) place_apart();
  return data_.data();
}

void ChunkTable::share() {
  if (data_.size() <= kFew) return;
  std::unordered_map<std::uint64_t, Index> known;
  std::vector<Index> first;  // offset in data_ of the first chunk of each group of equal ones
  std::vector<Index> place(place_.size());
  for (std::size_t i = 0; i < place.size(); ++i) {
    const double* chunk = data_.data() + place_[i];
    const auto [found, is_new] = known.try_emplace(hash_of(chunk, width_), static_cast<Index>(first.size()));
    const auto bytes = static_cast<std::size_t>(width_) * sizeof(double);
    if (!is_new && std::memcmp(data_.data() + first[static_cast<std::size_t>(found->second)], chunk, bytes) == 0) {
      place[i] = width_ * found->second;
      continue;
    }
    place[i] = width_ * static_cast<Index>(first.size());
    first.push_back(place_[i]);
    if (static_cast<Index>(first.size()) > kDifferent + static_cast<Index>(i) / kPart) return;
  }
  if (kPart * static_cast<Index>(first.size()) > static_cast<Index>(place.size())) return;
  Vector shared(width_ * static_cast<Index>(first.size()));
  for (std::size_t i = 0; i < first.size(); ++i)
    std::copy_n(data_.data() + first[i], width_, shared.data() + width_ * static_cast<Index>(i));
  data_ = std::move(shared);
  place_ = std::move(place);
}

}  // namespace butee::linalg
