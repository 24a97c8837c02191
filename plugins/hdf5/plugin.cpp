#include "reader.hpp"
#include "writer.hpp"

BUTEE_PLUGIN(registrar) {
  using namespace butee;
  using namespace butee::plugins::hdf5;
  registrar.add(
      model::FieldFormat{"hdf5",
                         "fields of many nodes and the probes: fields.h5, and fields.xdmf for ParaView",
                         {},
                         [](const std::string& folder, const model::FieldLayout& layout) {
                           return std::make_unique<FieldFile>(folder, layout);
                         },
                         [](const std::string& folder) { return std::make_unique<FieldFileReader>(folder); }});
}
