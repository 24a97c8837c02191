#pragma once

#include <butee/core/error.hpp>
#include <butee/plugin/entry.hpp>

#include "handle.hpp"

namespace butee::plugins::hdf5 {

/// Reads fields.h5. If a run is still writing the file, it sees the contents at the time of
/// opening.
class FieldFileReader final : public model::FieldReader {
 public:
  explicit FieldFileReader(const std::string& folder);

  const model::FieldLayout& layout() const override { return layout_; }
  const std::vector<double>& times() const override { return times_; }
  void read(std::size_t record, std::size_t field, std::span<double> values) override;

 private:
  Handle file_;
  std::vector<Handle> sets_;
  model::FieldLayout layout_;
  std::vector<double> times_;
};

}  // namespace butee::plugins::hdf5
