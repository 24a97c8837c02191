#include "xdmf.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <span>

#include <butee/core/text.hpp>

namespace butee::plugins::hdf5 {
namespace {

constexpr std::int64_t kPolyvertex = 1, kPolyline = 2;  ///< XDMF's numbers of cell types
constexpr const char* kEnd = "  </Grid>\n</Domain></Xdmf>\n";
constexpr const char* kReal = "NumberType=\"Float\" Precision=\"8\"";
/// Copies may take at most 1/kShareOfTime of the run time.
constexpr int kShareOfTime = 50;
constexpr const char* kWhole = "NumberType=\"Int\" Precision=\"4\"";

/// Escapes text for an attribute of XML 1.0. XML 1.0 allows no control characters except tab and
/// line ends, not even as references; the others and the noncharacters U+FFFE and U+FFFF become
/// U+FFFD.
std::string escaped(const std::string& text) {
  constexpr const char* kReplacement = "\xEF\xBF\xBD";
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '"')
      out += "&quot;";
    else if (c == '\t' || c == '\n' || c == '\r')
      out += "&#" + std::to_string(c) + ";";
    else if (c < 0x20)
      out += kReplacement;
    else if (const std::string next = text.substr(i, 3); next == "\xEF\xBF\xBE" || next == "\xEF\xBF\xBF")
      out += kReplacement, i += 2;
    else
      out += text[i];
  }
  return out;
}

std::size_t cell_count(const model::FieldLayout& layout) {
  std::size_t on_lines = 0;
  for (const model::FieldLine& line : layout.lines) on_lines += line.nodes.size();
  return layout.lines.size() + layout.nodes.size() - on_lines;
}

/// The XDMF item for a dataset with dimensions `size`.
std::string item(const std::string& path, const std::string& size, const char* type) {
  return "<DataItem Format=\"HDF\" Dimensions=\"" + size + "\" " + type + ">fields.h5:" + path + "</DataItem>";
}

/// A vector attribute of three fields; an empty name stands for zero. Empty if all names are empty.
std::string vector_attribute(const std::string& name, const std::string& nodes,
                             std::span<const std::string, 3> components) {
  if (components[0].empty() && components[1].empty() && components[2].empty()) return "";
  std::string text = "    <Attribute Name=\"" + name + "\" AttributeType=\"Vector\"><DataItem ItemType=\"Function\" ";
  text += "Function=\"JOIN($0 , $1 , $2)\" Dimensions=\"" + nodes + " 3\">";
  for (const std::string& component : components)
    text += component.empty() ? item("/nodes/zero", nodes, kReal) : component;
  return text + "</DataItem></Attribute>\n";
}

}  // namespace

std::vector<std::int64_t> mixed_topology(const model::FieldLayout& layout) {
  std::vector<std::int64_t> cells;
  std::vector<bool> on_line(layout.nodes.size());
  for (const model::FieldLine& line : layout.lines) {
    cells.push_back(kPolyline);
    cells.push_back(static_cast<std::int64_t>(line.nodes.size()));
    for (const Index node : line.nodes) {
      cells.push_back(node);
      on_line[static_cast<std::size_t>(node)] = true;
    }
  }
  for (std::size_t i = 0; i < on_line.size(); ++i)
    if (!on_line[i]) cells.insert(cells.end(), {kPolyvertex, 1, static_cast<std::int64_t>(i)});
  return cells;
}

XdmfFile::XdmfFile(const std::string& folder, const model::FieldLayout& layout)
    : path_(folder + "/fields.xdmf"),
      part_(path_ + ".part"),
      nodes_(layout.nodes.size()),
      file_(std::fopen(part_.c_str(), "w+b")) {
  if (!file_) complain(part_, errno);
  layout_.fields = layout.fields;
  const std::string count = std::to_string(nodes_);
  mesh_ = "<Topology TopologyType=\"Mixed\" NumberOfElements=\"" + std::to_string(cell_count(layout)) + "\">";
  mesh_ += item("/topology", std::to_string(mixed_topology(layout).size()), "NumberType=\"Int\" Precision=\"8\"");
  mesh_ += "</Topology>\n    <Geometry GeometryType=\"XYZ\">" + item("/nodes/position", count + " 3", kReal);
  mesh_ += "</Geometry>\n";
  std::string text =
      "<?xml version=\"1.0\" ?>\n<!-- made by butee; in ParaView take the reader \"XDMF Reader\" -->\n"
      "<Xdmf Version=\"2.0\"><Domain>\n  <Grid Name=\"";
  text += escaped(layout.title.empty() ? "butee" : layout.title);
  text += "\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
  write(text);
}

void XdmfFile::add(std::size_t record, std::size_t records, double t) {
  const std::string nodes = std::to_string(nodes_);
  std::string text = "  <Grid Name=\"scene\"><Time Value=\"";
  text += to_text(t);
  text += "\"/>" + mesh_;
  std::array<std::string, 6> components;  ///< ux, uy, uz, rx, ry, rz
  for (const model::Field& field : layout_.fields) {
    std::string slab = "<DataItem ItemType=\"HyperSlab\" Dimensions=\"" + nodes + "\"><DataItem Format=\"XML\" ";
    slab += "Dimensions=\"3 2\">" + std::to_string(record) + " 0 1 1 1 " + nodes + "</DataItem>";
    slab += item("/fields/" + field.name, std::to_string(records) + " " + nodes, field.whole ? kWhole : kReal);
    slab += "</DataItem>";
    text += "    <Attribute Name=\"" + field.name + "\" AttributeType=\"Scalar\">" + slab + "</Attribute>\n";
    if (const auto kind = dof_named(field.name)) components[static_cast<std::size_t>(*kind)] = slab;
  }
  text += vector_attribute("displacement", nodes, std::span(components).first<3>());
  // A rotation in the plane is the field theta itself.
  if (!components[3].empty() || !components[4].empty())
    text += vector_attribute("rotation", nodes, std::span(components).last<3>());
  text += "  </Grid>\n";
  write(text);
}

void XdmfFile::complain(const std::string& path, int error) const {
  throw RunError(path + ": cannot be written: " + std::strerror(error));
}

void XdmfFile::write(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size()) complain(part_, errno);
}

void XdmfFile::close_document() {
  write(kEnd);
  if (std::fflush(file_.get()) != 0) complain(part_, errno);
}

void XdmfFile::publish() {
  const Clock::time_point now = Clock::now();
  if (now - published_ < kShareOfTime * cost_) return;
  close_document();
  const std::string copy = path_ + ".new";
  std::error_code error;
  std::filesystem::copy_file(part_, copy, std::filesystem::copy_options::overwrite_existing, error);
  if (!error) std::filesystem::rename(copy, path_, error);
  if (error) complain(path_, error.value());
  if (std::fseek(file_.get(), -static_cast<long>(std::strlen(kEnd)), SEEK_END) != 0) complain(part_, errno);
  published_ = Clock::now();
  cost_ = published_ - now;
}

void XdmfFile::finish() {
  close_document();
  std::error_code error;
  std::filesystem::rename(part_, path_, error);
  if (error) complain(path_, error.value());
}

}  // namespace butee::plugins::hdf5
