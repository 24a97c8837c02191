#pragma once

#include <vector>

#include "butee/model/types.hpp"
#include "butee/time/integrator.hpp"

namespace butee::plugin {

/// The types of a module.
struct ModuleTypes {
  std::vector<time::IntegratorType> integrators{};
  std::vector<model::LawType> laws{};
  std::vector<model::ContactType> contacts{};
  std::vector<model::LoadType> loads{};
  std::vector<model::ElementType> elements{};
  std::vector<model::FieldFormat> formats{};
};

/// Receives the types that a module registers. They take effect only after the whole module has
/// been read without error.
class BUTEE_EXPORT Registrar {
 public:
  void add(time::IntegratorType type) { types_.integrators.push_back(std::move(type)); }
  void add(model::LawType type) { types_.laws.push_back(std::move(type)); }
  void add(model::ContactType type) { types_.contacts.push_back(std::move(type)); }
  void add(model::LoadType type) { types_.loads.push_back(std::move(type)); }
  void add(model::ElementType type) { types_.elements.push_back(std::move(type)); }
  void add(model::FieldFormat type) { types_.formats.push_back(std::move(type)); }

  ModuleTypes& types() { return types_; }

 private:
  ModuleTypes types_;
};

}  // namespace butee::plugin
