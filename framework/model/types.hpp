#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "butee/config/parameters.hpp"
#include "butee/model/field_format.hpp"
#include "butee/model/model.hpp"
#include "butee/model/section.hpp"

namespace butee::model {

/// What an element type may ask of the scene while one of its elements is made. Every reading function reports a
/// mistake itself and then returns nothing.
class BUTEE_EXPORT ElementContext {
 public:
  virtual ~ElementContext() = default;

  /// The first node of those that the element created itself.
  virtual NodeId own_node() const = 0;
  /// The one node that the selector in `key` names.
  virtual std::optional<NodeId> node(const config::Parameters& parameters, const std::string& key) = 0;
  /// The nodes that the selectors in `key` name, in their order.
  virtual std::optional<std::vector<NodeId>> nodes(const config::Parameters& parameters, const std::string& key) = 0;
  virtual std::optional<Material> material(const config::Parameters& parameters, const std::string& key) = 0;
  virtual std::optional<Section> section(const config::Parameters& parameters, const std::string& key) = 0;
  /// Says where a chain of nodes lies in space; without it, along x from the origin.
  virtual void place(NodeId first, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) = 0;
  /// Makes two nodes one.
  virtual void join(NodeId a, NodeId b) = 0;
  virtual config::Diagnostics& diagnostics() = 0;
  /// The nodes of a selector, such as one in a file, or the reason why there are none.
  virtual Selection select(std::string_view selector) = 0;
  /// The node that stands for `node` and all that were joined to it.
  virtual NodeId canonical(NodeId node) const = 0;
};

/// A kind of [[element]]. Keys `type` and `name` are read for it.
struct ElementType {
  /// The nodes that an element creates: none, a lone one (no coordinates), or a chain (coordinates in m).
  using Nodes = std::optional<std::vector<double>>;

  std::string name, summary;
  std::vector<config::Parameter> parameters;
  std::function<Nodes(const config::Parameters&, config::Diagnostics&)> nodes;
  /// Returns nothing where it reported a mistake.
  std::function<std::unique_ptr<Element>(const config::Parameters&, ElementContext&)> make;
};

/// A shape of [section.NAME].
struct SectionType {
  std::string name, summary;
  std::vector<config::Parameter> parameters;
  std::function<std::optional<Section>(const config::Parameters&, config::Diagnostics&)> make;
};

/// A law of [[contact]].
struct LawType {
  std::string name, summary;
  std::vector<config::Parameter> parameters;
  std::function<std::unique_ptr<ContactLaw>(const config::Parameters&, config::Diagnostics&)> make;
};

/// A kind of [[contact]] in the plane of two displacements.
struct ContactType {
  std::string name, summary;
  std::vector<config::Parameter> parameters;
  /// The shape with this gap (m); nothing where it reported a mistake.
  std::function<std::unique_ptr<ContactShape>(const config::Parameters&, double gap, config::Diagnostics&)> make;
};

/// A course in time: a type of [[load]] and of `in_time`.
struct LoadType {
  std::string name, summary;
  std::vector<config::Parameter> parameters;
  std::function<std::unique_ptr<TimeFunction>(const config::Parameters&, config::Diagnostics&)> make;
};

/// All the types that a scene may name.
struct ModelTypes {
  std::vector<ElementType> elements;
  std::vector<SectionType> sections;
  std::vector<LawType> laws;
  std::vector<ContactType> contacts;
  std::vector<LoadType> loads;
  std::vector<FieldFormat> formats;
};

template <class Type>
const Type* find_type(const std::vector<Type>& types, std::string_view name) {
  for (const Type& type : types)
    if (type.name == name) return &type;
  return nullptr;
}

template <class Type>
std::vector<std::string> type_names(const std::vector<Type>& types) {
  std::vector<std::string> names;
  for (const Type& type : types) names.push_back(type.name);
  return names;
}

/// The histories in time that the framework brings along: harmonic, constant, ramp, table, unbalance.
BUTEE_EXPORT std::vector<LoadType> standard_load_types();

}  // namespace butee::model
