#include "history_rows.hpp"

namespace butee::plugins::hdf5 {
namespace {

constexpr std::size_t kRowsInChunk = 512;  ///< 4 kB for each column

}  // namespace

HistoryRows::HistoryRows(hid_t file, const std::vector<model::Field>& columns)
    : waiting_(columns.size() * kRowsInChunk) {
  make_group(file, "probes");
  for (const model::Field& column : columns) {
    sets_.push_back(make_growing(file, "/probes/" + column.name, H5T_IEEE_F64LE, {kRowsInChunk}, {0}, false));
    write_attribute(sets_.back(), "unit", column.unit);
  }
}

bool HistoryRows::append(std::span<const double> values) {
  for (std::size_t column = 0; column < sets_.size(); ++column)
    waiting_[column * kRowsInChunk + waiting_rows_] = values[column];
  ++waiting_rows_;
  const std::size_t in_chunk = rows_ % kRowsInChunk;
  const bool full = in_chunk + waiting_rows_ == kRowsInChunk;
  if (!full && (waiting_rows_ < in_chunk || Clock::now() - committed_ <= kPatience)) return false;
  commit();
  return true;
}

void HistoryRows::commit() {
  if (waiting_rows_ == 0) return;
  for (std::size_t column = 0; column < sets_.size(); ++column)
    extend(sets_[column], rows_, waiting_rows_, waiting_.data() + column * kRowsInChunk);
  rows_ += waiting_rows_;
  waiting_rows_ = 0;
  committed_ = Clock::now();
}

bool HistoryRows::close() {
  bool closed = true;
  for (Handle& set : sets_) closed = set.reset() && closed;
  sets_.clear();
  return closed;
}

}  // namespace butee::plugins::hdf5
