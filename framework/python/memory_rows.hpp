#pragma once

#include <cstring>
#include <mutex>
#include <vector>

#include "butee/study/rows.hpp"

namespace butee::python {

/// The rows of a study in memory, in the order of the plan. Sweeps cannot be continued.
class MemoryRows final : public study::Rows {
 public:
  MemoryRows(std::int64_t runs, const study::Layout& layout)
      : row_bytes_(layout.row_bytes()),
        run_column_(layout.find(study::kRunColumn)),
        bytes_(static_cast<std::size_t>(runs) * row_bytes_) {}

  bool is_done(std::int64_t) const override { return false; }
  std::int64_t done_count() const override { return 0; }
  void append(const study::Row& row) override {
    const auto run = static_cast<std::size_t>(row.integer(run_column_));
    const std::lock_guard guard(mutex_);
    std::memcpy(bytes_.data() + run * row_bytes_, row.bytes().data(), row_bytes_);
  }
  void flush() override {}
  void keep(std::int64_t, std::int64_t, const study::Motion&) override {}
  std::int64_t kept(std::int64_t, study::Motion&) const override { return -1; }
  void forget(std::int64_t) override {}

  std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  std::size_t row_bytes_, run_column_;
  std::vector<std::byte> bytes_;
  std::mutex mutex_;
};

}  // namespace butee::python
