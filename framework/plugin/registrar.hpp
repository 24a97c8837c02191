#pragma once

#include <vector>

#include "butee/time/integrator.hpp"

namespace butee::plugin {

/// Takes the types that a module registers. Nothing counts until the whole module has been read without a mistake.
class BUTEE_EXPORT Registrar {
 public:
  void add(time::IntegratorType type) { integrators_.push_back(std::move(type)); }

  std::vector<time::IntegratorType>& integrators() { return integrators_; }

 private:
  std::vector<time::IntegratorType> integrators_;
};

}  // namespace butee::plugin
