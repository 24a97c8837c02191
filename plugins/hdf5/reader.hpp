#pragma once

#include <butee/core/error.hpp>
#include <butee/plugin/entry.hpp>

#include "handle.hpp"

namespace butee::plugins::hdf5 {

/// Reads fields.h5. Of a file to which a run is still adding it sees what was there when it was opened.
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
