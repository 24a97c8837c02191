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

/// Access to the scene for an element type while one of its elements is made. Every reading
/// function reports errors itself and then returns nothing.
class BUTEE_EXPORT ElementContext {
 public:
  virtual ~ElementContext() = default;

  /// The first of the nodes that the element itself created.
  virtual NodeId own_node() const = 0;
  /// The one node that the selector in `key` names.
  virtual std::optional<NodeId> node(const config::Parameters& parameters, const std::string& key) = 0;
  /// The nodes that the selectors in `key` name, in their order.
  virtual std::optional<std::vector<NodeId>> nodes(const config::Parameters& parameters, const std::string& key) = 0;
  virtual std::optional<Material> material(const config::Parameters& parameters, const std::string& key) = 0;
  virtual std::optional<Section> section(const config::Parameters& parameters, const std::string& key) = 0;
  /// Sets the position in space of a chain of nodes; by default it lies along x from the origin.
  virtual void place(NodeId first, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) = 0;
  /// Joins two nodes into one.
  virtual void join(NodeId a, NodeId b) = 0;
  virtual config::Diagnostics& diagnostics() = 0;
  /// The nodes of a selector, for example one in a file, or the reason why there are none.
  virtual Selection select(std::string_view selector) = 0;
  /// The representative of `node` and all nodes joined to it.
  virtual NodeId canonical(NodeId node) const = 0;
};

/// A type of [[element]]. The framework reads the keys `type` and `name`.
struct ElementType {
  /// The nodes that an element creates: none, a lone one (no coordinates), or a chain (coordinates in m).
  using Nodes = std::optional<std::vector<double>>;

  std::string name, summary;
  std::vector<config::Parameter> parameters;
  std::function<Nodes(const config::Parameters&, config::Diagnostics&)> nodes;
  /// Returns nothing if it reported an error.
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

/// A type of [[contact]] in the plane of two displacements.
struct ContactType {
  std::string name, summary;
  std::vector<config::Parameter> parameters;
  /// The shape with this gap (m); nothing if it reported an error.
  std::function<std::unique_ptr<ContactShape>(const config::Parameters&, double gap, config::Diagnostics&)> make;
};

/// A function of time: a type of [[load]] and of `in_time`.
struct LoadType {
  std::string name, summary;
  std::vector<config::Parameter> parameters;
  std::function<std::unique_ptr<TimeFunction>(const config::Parameters&, config::Diagnostics&)> make;
};

/// All types that a scene may name.
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

/// The time functions of the framework: harmonic, constant, ramp, table, unbalance.
BUTEE_EXPORT std::vector<LoadType> standard_load_types();

}  // namespace butee::model
