#include "growing.hpp"

namespace butee::plugins::hdf5 {
namespace {

constexpr unsigned kDeflate = 1;  ///< higher levels take several times as long and save a few percent

}  // namespace

void make_group(hid_t file, const char* name) {
  const Handle group(H5Gcreate2(file, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose,
                     std::string("make ") + name);
}

Handle make_growing(hid_t file, const std::string& path, hid_t type, const Sizes& chunk, Sizes size, bool packed) {
  Sizes most = size;
  size[0] = 0;
  most[0] = H5S_UNLIMITED;
  const int rank = static_cast<int>(size.size());
  const Handle space(H5Screate_simple(rank, size.data(), most.data()), H5Sclose, "make " + path);
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "make " + path);
  check(H5Pset_chunk(creation, rank, chunk.data()), "make " + path);
  if (packed) {
    check(H5Pset_shuffle(creation), "make " + path);
    check(H5Pset_deflate(creation, kDeflate), "make " + path);
  }
  return {H5Dcreate2(file, path.c_str(), type, space, H5P_DEFAULT, creation, H5P_DEFAULT), H5Dclose, "make " + path};
}

void extend(hid_t set, std::size_t before, std::size_t rows, const double* values) {
  Sizes size = size_of(set), start(size.size(), 0), count = size;
  size[0] = before + rows;
  start[0] = before;
  count[0] = rows;
  check(H5Dset_extent(set, size.data()), "extend fields.h5");
  const Handle file(H5Dget_space(set), H5Sclose, "extend fields.h5");
  const Handle memory(H5Screate_simple(static_cast<int>(count.size()), count.data(), nullptr), H5Sclose,
                      "extend fields.h5");
  check(H5Sselect_hyperslab(file, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr), "extend fields.h5");
  check(H5Dwrite(set, H5T_NATIVE_DOUBLE, memory, file, H5P_DEFAULT, values), "write fields.h5");
}

}  // namespace butee::plugins::hdf5
