#pragma once

#include <cstdio>
#include <memory>
#include <string>

#include <butee/core/error.hpp>
#include <butee/plugin/entry.hpp>

namespace butee::plugins::hdf5 {

/// fields.xdmf, which says to ParaView and other programs what is what in fields.h5. It grows with that: after every
/// record it is a whole document again.
class XdmfFile {
 public:
  XdmfFile(const std::string& folder, const model::FieldLayout& layout);

  /// Adds record number `record` of the `records` that fields.h5 holds by now; times in s. Throws RunError.
  void add(std::size_t record, std::size_t records, double t);

 private:
  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  /// Writes over the end of the document, and the end again behind it.
  void write(const std::string& text);

  std::string path_, mesh_;
  model::FieldLayout layout_;  ///< fields and title alone
  std::size_t nodes_;
  std::unique_ptr<std::FILE, Closer> file_;
  long end_ = 0;  ///< of what stays when more is added
};

/// The cells of the layout as XDMF's mixed topology: a polyline for each line, one point for each node in none.
std::vector<std::int64_t> mixed_topology(const model::FieldLayout& layout);

}  // namespace butee::plugins::hdf5
