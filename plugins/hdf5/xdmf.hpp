#pragma once

#include <chrono>
#include <cstdio>
#include <memory>
#include <string>

#include <butee/core/error.hpp>
#include <butee/plugin/entry.hpp>

namespace butee::plugins::hdf5 {

/// Writes fields.xdmf, which describes the contents of fields.h5 to ParaView and other programs.
///
/// The text accumulates in fields.xdmf.part. A complete document is written under another name and
/// then renamed to fields.xdmf, so that readers never find an incomplete one, even if the run is
/// killed.
class XdmfFile {
 public:
  XdmfFile(const std::string& folder, const model::FieldLayout& layout);

  /// Adds record number `record` of the `records` that fields.h5 holds so far; time `t` in s.
  /// Throws RunError.
  void add(std::size_t record, std::size_t records, double t);
  /// Updates fields.xdmf, unless that would take a large part of the run time; the cost of a copy
  /// grows with its size.
  void publish();
  /// Writes the final fields.xdmf; no record may be added afterwards.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;

  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  void write(const std::string& text);
  void close_document();
  [[noreturn]] void complain(const std::string& path, int error) const;

  std::string path_, part_, mesh_;
  model::FieldLayout layout_;  ///< fields and title only
  std::size_t nodes_;
  std::unique_ptr<std::FILE, Closer> file_;
  Clock::time_point published_;
  Clock::duration cost_{};  ///< time taken by the last copy
};

/// The cells of the layout as XDMF's mixed topology: a polyline for each line, a point for each
/// node that is in no line.
std::vector<std::int64_t> mixed_topology(const model::FieldLayout& layout);

}  // namespace butee::plugins::hdf5
