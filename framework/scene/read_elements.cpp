#include <algorithm>

#include "butee/core/memory.hpp"
#include "butee/core/text.hpp"
#include "butee/scene/keys_of_others.hpp"
#include "butee/scene/scene_reader.hpp"

namespace butee::scene {

using config::Parameters;
using config::Value;

namespace {

/// Minimum memory of a run per node with two degrees of freedom: rk4 on a chain of 2e5 beams,
/// measured. Other methods and meshes need more.
constexpr double kBytesOfNode = 1100.0;

}  // namespace

/// Answers an element type's queries from the scene being read.
class ReadingContext final : public ElementContext {
 public:
  ReadingContext(SceneReader& reader, NodeId own_node) : reader_(reader), own_node_(own_node) {}

  NodeId own_node() const override { return own_node_; }
  std::optional<NodeId> node(const Parameters& parameters, const std::string& key) override {
    return reader_.select_one(parameters, key);
  }
  std::optional<std::vector<NodeId>> nodes(const Parameters& parameters, const std::string& key) override {
    return reader_.select(parameters, key);
  }
  std::optional<Material> material(const Parameters& parameters, const std::string& key) override {
    return look_up(reader_.materials_, "material", parameters, key);
  }
  std::optional<Section> section(const Parameters& parameters, const std::string& key) override {
    return look_up(reader_.sections_, "section", parameters, key);
  }
  void place(NodeId first, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) override {
    reader_.model_.nodes.place(first, {origin[0], origin[1], origin[2]}, {direction[0], direction[1], direction[2]});
  }
  void join(NodeId a, NodeId b) override { reader_.model_.nodes.join(a, b); }
  config::Diagnostics& diagnostics() override { return reader_.diagnostics_; }
  Selection select(std::string_view selector) override { return reader_.model_.nodes.select(selector); }
  NodeId canonical(NodeId node) const override { return reader_.model_.nodes.canonical(node); }

 private:
  template <class Item>
  std::optional<Item> look_up(const std::map<std::string, std::optional<Item>>& items, const std::string& what,
                              const Parameters& parameters, const std::string& key) {
    const std::string& name = parameters.text(key);
    const auto found = items.find(name);
    if (found != items.end()) return found->second;
    const Value* tables = reader_.root_.table()->find(what);
    if (tables != nullptr && tables->table() == nullptr) return std::nullopt;
    std::vector<std::string> known;
    for (const auto& item : items) known.push_back(item.first);
    parameters.complain(reader_.diagnostics_, key,
                        "there is no [" + what + "." + name + "]" + suggestion(name, known) +
                            (known.empty() ? "" : "; known: " + butee::join(known)));
    return std::nullopt;
  }

  SceneReader& reader_;
  NodeId own_node_;
};

void SceneReader::read_elements() {
  std::vector<PendingElement> pending;
  for (const auto& [entry, path] : entries("element")) {
    auto element = read_element(*entry, path);
    if (element) {
      pending.push_back(std::move(*element));
    } else {
      excuse_names_of(*entry);
    }
  }
  const Value* list = root_.table()->find("element");
  const bool is_empty = list == nullptr || (list->array() != nullptr && list->array()->empty());
  if (is_empty)
    diagnostics_.error("element", list != nullptr ? list->at : root_.at,
                       "missing; a scene has at least one [[element]]");
  if (is_empty || list->array() == nullptr) excuse_names_of(Value());
  for (PendingElement& waiting : pending) {
    ReadingContext context(*this, waiting.own_node);
    auto element = waiting.type->make(waiting.parameters, context);
    if (element == nullptr) {
      lacks_elements_ = true;
      continue;
    }
    element_places_.emplace_back(waiting.parameters.path(), waiting.parameters.at());
    if (waiting.parameters.has("name")) named_elements_.emplace_back(waiting.parameters.text("name"), element.get());
    model_.element_names.push_back(waiting.parameters.has("name") ? waiting.parameters.text("name") : "");
    model_.elements.push_back(std::move(element));
  }
}

/// An element placed on nodes of others may lack a name; any other unnamed element may be the
/// target of a selector.
void SceneReader::excuse_names_of(const Value& entry) {
  lacks_elements_ = true;
  const config::Table* table = entry.table();
  const Value* name = table != nullptr ? table->find("name") : nullptr;
  if (name != nullptr && name->text() != nullptr)
    model_.nodes.excuse(*name->text());
  else if (table == nullptr || (table->find("node") == nullptr && table->find("nodes") == nullptr))
    model_.nodes.excuse("");
}

std::optional<SceneReader::PendingElement> SceneReader::read_element(const Value& entry, const std::string& path) {
  const auto type_name = type_of(entry, path, "type", type_names(types_.elements));
  if (!type_name) return std::nullopt;
  const ElementType& type = *find_type(types_.elements, *type_name);

  std::vector<config::Parameter> declared = type.parameters;
  declared.insert(declared.begin(), config::text("name", "the name of the element").optional());
  std::vector<std::string> known = config::names_of(declared);
  known.emplace_back("type");
  report_keys_of_others(entry, path, "type = \"" + *type_name + "\"", types_.elements, known, diagnostics_);
  auto parameters = read_parameters(entry, path, declared, diagnostics_, known);
  if (!parameters || too_large_) return std::nullopt;

  const std::size_t errors_before = diagnostics_.error_count();
  const auto coordinates = type.nodes(*parameters, diagnostics_);
  const bool named = parameters->has("name");
  if (named && !is_plain_name(parameters->text("name")))
    parameters->complain(diagnostics_, "name", "must be made of A to Z, a to z, digits, _ and -");
  if (!named && coordinates)
    diagnostics_.error(path + ".name", entry.at, "missing; give the name by which its nodes are selected");
  const auto same_name = [&](const auto& other) { return named && other == parameters->text("name"); };
  if (std::any_of(element_names_.begin(), element_names_.end(), same_name))
    parameters->complain(diagnostics_, "name", "is taken by another element; names are unique");
  if (coordinates) check_size(*coordinates, path, entry);
  if (diagnostics_.error_count() > errors_before) return std::nullopt;

  if (named) element_names_.push_back(parameters->text("name"));
  const NodeId own_node = coordinates ? model_.nodes.add(parameters->text("name"), *coordinates) : -1;
  return PendingElement{&type, std::move(*parameters), own_node};
}

void SceneReader::check_size(const std::vector<double>& coordinates, const std::string& path, const Value& entry) {
  const double nodes = static_cast<double>(model_.nodes.size()) + static_cast<double>(coordinates.size());
  const std::string complaint = memory_complaint(nodes * kBytesOfNode);
  too_large_ = !complaint.empty();
  if (too_large_)
    diagnostics_.error(path, entry.at,
                       "with this element the scene has " + to_short_text(2.0 * nodes) + " degrees of freedom and " +
                           complaint + "; take fewer elements");
}

}  // namespace butee::scene
