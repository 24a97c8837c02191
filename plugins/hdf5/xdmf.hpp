#pragma once

#include <chrono>
#include <cstdio>
#include <memory>
#include <string>

#include <butee/core/error.hpp>
#include <butee/plugin/entry.hpp>

namespace butee::plugins::hdf5 {

/// fields.xdmf, which says to ParaView and other programs what is what in fields.h5.
///
/// It grows as fields.xdmf.part. Whole documents take the place of fields.xdmf under another name first, so that a
/// reader, or a run that is killed, never meets half of one.
class XdmfFile {
 public:
  XdmfFile(const std::string& folder, const model::FieldLayout& layout);

  /// Adds record number `record` of the `records` that fields.h5 holds by now; times in s. Throws RunError.
  void add(std::size_t record, std::size_t records, double t);
  /// Makes fields.xdmf of what was added, unless that would take up much of the run: a copy costs more as it grows.
  void publish();
  /// Makes fields.xdmf of everything; nothing is added any more.
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
  model::FieldLayout layout_;  ///< fields and title alone
  std::size_t nodes_;
  std::unique_ptr<std::FILE, Closer> file_;
  Clock::time_point published_;
  Clock::duration cost_{};  ///< of the last copy
};

/// The cells of the layout as XDMF's mixed topology: a polyline for each line, one point for each node in none.
std::vector<std::int64_t> mixed_topology(const model::FieldLayout& layout);

}  // namespace butee::plugins::hdf5
