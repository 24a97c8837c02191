#include "butee/core/error.hpp"
#include "butee/study/extension.hpp"
#include "butee/study/row_file.hpp"

namespace butee::study {

std::unique_ptr<RowFormat> hdf5_format() {
  const auto make = find_extension("study_hdf5", "butee_study_hdf5");
  if (make == nullptr)
    throw InputError(
        "the store hdf5 is not installed: install HDF5 (Debian: libhdf5-dev) and build butee again, or "
        "take --format csv");
  return std::unique_ptr<RowFormat>(static_cast<RowFormat*>(make()));
}

std::unique_ptr<RowFormat> row_format(const std::string& name) {
  if (name == "csv") return csv_format();
  if (name == "hdf5") return hdf5_format();
  require(name.empty(), "a store is csv or hdf5");
  return find_extension("study_hdf5", "butee_study_hdf5") != nullptr ? hdf5_format() : csv_format();
}

}  // namespace butee::study
