#include "reader.hpp"

#include <algorithm>

namespace butee::plugins::hdf5 {
namespace {

/// Names in a group, in order of creation if the file records it, else in alphabetical order.
std::vector<std::string> names_in(hid_t file, const char* group) {
  const Handle opened(H5Gopen2(file, group, H5P_DEFAULT), H5Gclose, std::string("read ") + group);
  std::vector<std::string> names;
  check(H5Literate(
            opened, H5_INDEX_NAME, H5_ITER_INC, nullptr,
            [](hid_t, const char* name, const H5L_info_t*, void* to) -> herr_t {
              static_cast<std::vector<std::string>*>(to)->emplace_back(name);
              return 0;
            },
            &names),
        std::string("read ") + group);
  return names;
}

}  // namespace

FieldFileReader::FieldFileReader(const std::string& folder) {
  be_silent();
  const std::string path = folder + "/fields.h5";
  file_ = Handle(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose, "open " + path);
  if (read_attribute(file_, "made_by") != "butee fields 1")
    throw RunError(path + ": holds no fields of this version of butee");
  layout_.title = read_attribute(file_, "title");
  layout_.nodes = read_texts(file_, "/nodes/name");
  layout_.coordinates = read_numbers(file_, "/nodes/coordinate");
  const auto positions = read_numbers(file_, "/nodes/position");
  for (std::size_t i = 0; i + 2 < positions.size(); i += 3)
    layout_.positions.push_back({positions[i], positions[i + 1], positions[i + 2]});
  if (layout_.coordinates.size() != layout_.nodes.size() || layout_.positions.size() != layout_.nodes.size())
    throw RunError(path + ": /nodes is damaged: its data sets differ in size");
  const auto names = read_texts(file_, "/lines/name");
  const auto begins = read_numbers(file_, "/lines/begin"), members = read_numbers(file_, "/lines/node");
  const auto is_in = [](double place, std::size_t size) { return place >= 0.0 && place < static_cast<double>(size); };
  const auto check_lines = [&path](bool is_right) {
    if (!is_right) throw RunError(path + ": /lines is damaged: it does not fit its nodes");
  };
  check_lines(begins.size() == names.size() + 1);
  for (std::size_t i = 0; i < names.size(); ++i) {
    layout_.lines.push_back({names[i], {}});
    check_lines(is_in(begins[i], members.size() + 1) && is_in(begins[i + 1], members.size() + 1));
    for (auto k = static_cast<std::size_t>(begins[i]); k < static_cast<std::size_t>(begins[i + 1]); ++k) {
      check_lines(is_in(members[k], layout_.nodes.size()));
      layout_.lines.back().nodes.push_back(static_cast<Index>(members[k]));
    }
  }
  times_ = read_numbers(file_, "/time");
  for (const std::string& name : names_in(file_, "/fields")) {
    const std::string set = "/fields/" + name;
    sets_.emplace_back(H5Dopen2(file_, set.c_str(), H5P_DEFAULT), H5Dclose, "read " + set);
    const Sizes size = size_of(sets_.back());
    if (size.size() != 2 || size[1] != layout_.nodes.size()) throw RunError(path + ": " + set + " has a wrong size");
    const Handle type(H5Dget_type(sets_.back()), H5Tclose, "read " + set);
    layout_.fields.push_back({name, read_attribute(sets_.back(), "unit"), H5Tget_class(type) == H5T_INTEGER});
    times_.resize(std::min<std::size_t>(times_.size(), size[0]));
  }
}

void FieldFileReader::read(std::size_t record, std::size_t field, std::span<double> values) {
  require(record < times_.size() && field < sets_.size() && values.size() == layout_.nodes.size(), "no such record");
  const Sizes start = {record, 0}, count = {1, values.size()};
  const Handle file(H5Dget_space(sets_[field]), H5Sclose, "read fields.h5");
  const Handle memory(H5Screate_simple(2, count.data(), nullptr), H5Sclose, "read fields.h5");
  check(H5Sselect_hyperslab(file, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr), "read fields.h5");
  check(H5Dread(sets_[field], H5T_NATIVE_DOUBLE, memory, file, H5P_DEFAULT, values.data()), "read fields.h5");
}

}  // namespace butee::plugins::hdf5
