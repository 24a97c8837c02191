#include "writer.hpp"

#include <algorithm>

#include "growing.hpp"

namespace butee::plugins::hdf5 {
namespace {

constexpr std::size_t kChunkValues = std::size_t{1} << 17;  ///< a megabyte of doubles
constexpr std::size_t kMostRows = 512;                      ///< largest number of rows of a chunk
/// Shortest time between flushes. They should be rare, since the library overwrites its metadata
/// piece by piece: a reader that opens the file in between must retry, and a kill in between damages
/// the file.
constexpr auto kPause = std::chrono::milliseconds(500);

Handle create_file(const std::string& path) {
  const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose, "set up a file");
  check(H5Pset_file_space_strategy(creation, H5F_FSPACE_STRATEGY_NONE, false, 1), "set up a file");
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "set up a file");
  H5AC_cache_config_t cache{};
  cache.version = H5AC__CURR_CACHE_CONFIG_VERSION;
  check(H5Pget_mdc_config(access, &cache), "set up a file");
  cache.evictions_enabled = false;
  cache.incr_mode = H5C_incr__off;
  cache.flash_incr_mode = H5C_flash_incr__off;
  cache.decr_mode = H5C_decr__off;
  check(H5Pset_mdc_config(access, &cache), "set up a file");
#if H5_VERSION_GE(1, 10, 7)
  // Other programs may read during the run.
  check(H5Pset_file_locking(access, false, true), "set up a file");
#endif
  return {H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation, access), H5Fclose, "make " + path};
}

}  // namespace

FieldFile::FieldFile(const std::string& folder, const model::FieldLayout& layout)
    : nodes_(layout.nodes.size()),
      fields_(layout.fields.size()),
      rows_(std::clamp<std::size_t>(kChunkValues / nodes_, 1, kMostRows)),
      xdmf_(folder, layout),
      waiting_(fields_ * rows_ * nodes_) {
  be_silent();
  file_ = create_file(folder + "/fields.h5");
  write_layout(layout);
  make_datasets(layout);
  history_ = HistoryRows(file_, layout.columns);
  check(H5Fflush(file_, H5F_SCOPE_LOCAL), "write fields.h5");
}

void FieldFile::write_layout(const model::FieldLayout& layout) {
  write_attribute(file_, "made_by", "butee fields 1");
  write_attribute(file_, "title", layout.title);
  for (const char* group : {"nodes", "lines", "fields"}) make_group(file_, group);
  write_texts(file_, "/nodes/name", layout.nodes);
  write_numbers(file_, "/nodes/coordinate", {nodes_}, H5T_NATIVE_DOUBLE, H5T_IEEE_F64LE, layout.coordinates.data());
  write_numbers(file_, "/nodes/position", {nodes_, 3}, H5T_NATIVE_DOUBLE, H5T_IEEE_F64LE, layout.positions.data());
  // Never written, so it takes no space; serves as the zero components of vectors in ParaView.
  write_numbers(file_, "/nodes/zero", {nodes_}, H5T_NATIVE_DOUBLE, H5T_IEEE_F64LE, nullptr);
  std::vector<std::string> names;
  std::vector<std::int64_t> members, begins = {0};
  for (const model::FieldLine& line : layout.lines) {
    names.push_back(line.name);
    members.insert(members.end(), line.nodes.begin(), line.nodes.end());
    begins.push_back(static_cast<std::int64_t>(members.size()));
  }
  const auto whole = [this](const char* path, const std::vector<std::int64_t>& values) {
    write_numbers(file_, path, {values.size()}, H5T_NATIVE_INT64, H5T_STD_I64LE,
                  values.empty() ? nullptr : values.data());
  };
  write_texts(file_, "/lines/name", names);
  whole("/lines/begin", begins);
  whole("/lines/node", members);
  whole("/topology", mixed_topology(layout));
}

void FieldFile::make_datasets(const model::FieldLayout& layout) {
  time_ = make_growing(file_, "/time", H5T_IEEE_F64LE, {kMostRows}, {0}, false);
  write_attribute(time_, "unit", "s");
  const Sizes chunk = {rows_, std::min(nodes_, kChunkValues)};
  for (const model::Field& field : layout.fields) {
    const hid_t type = field.whole ? H5T_STD_I32LE : H5T_IEEE_F64LE;
    sets_.push_back(make_growing(file_, "/fields/" + field.name, type, chunk, {0, nodes_}, true));
    write_attribute(sets_.back(), "unit", field.unit);
  }
}

void FieldFile::append(double t, std::span<const double> values) {
  for (std::size_t field = 0; field < fields_; ++field)
    std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(field * nodes_), nodes_,
                waiting_.begin() + static_cast<std::ptrdiff_t>((field * rows_ + times_.size()) * nodes_));
  times_.push_back(t);
  const std::size_t in_chunk = records_ % rows_;
  const bool full = in_chunk + times_.size() == rows_;
  if (full || (times_.size() >= in_chunk && Clock::now() - committed_ > kPatience)) commit();
  flush_if_due();
}

void FieldFile::append_row(std::span<const double> values) {
  if (history_.append(values)) is_flushed_ = false;
  flush_if_due();
}

void FieldFile::flush_if_due() {
  if (is_flushed_ || Clock::now() - flushed_ <= kPause) return;
  flush();
  xdmf_.publish();
}

void FieldFile::flush() {
  check(H5Fflush(file_, H5F_SCOPE_LOCAL), "write fields.h5");
  is_flushed_ = true;
  flushed_ = Clock::now();
}

void FieldFile::commit() {
  if (times_.empty()) return;
  for (std::size_t field = 0; field < fields_; ++field)
    extend(sets_[field], records_, times_.size(), waiting_.data() + field * rows_ * nodes_);
  extend(time_, records_, times_.size(), times_.data());
  history_.commit();
  is_flushed_ = false;
  const std::size_t all = records_ + times_.size();
  for (const double t : times_) xdmf_.add(records_++, all, t);
  times_.clear();
  committed_ = Clock::now();
}

void FieldFile::finish() {
  commit();
  history_.commit();
  flush();
  xdmf_.finish();
  bool closed = history_.close();
  closed = time_.reset() && closed;
  for (Handle& set : sets_) closed = set.reset() && closed;
  sets_.clear();
  if (!file_.reset() || !closed) throw RunError("HDF5 cannot close fields.h5; is the disk full?");
}

}  // namespace butee::plugins::hdf5
