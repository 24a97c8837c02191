#pragma once

#include <optional>
#include <string>

#include "butee/config/parameters.hpp"
#include "butee/model/types.hpp"

namespace butee::scene {

/// Reads the tables `damping` and `friction` of a [[contact]]. Private to the framework.
class ContactTables {
 public:
  /// All arguments must outlive this object; `law` is the law's name, "" without one.
  ContactTables(const config::Parameters& contact, std::string path, std::string law, config::Diagnostics& diagnostics)
      : contact_(contact), path_(std::move(path)), law_(std::move(law)), diagnostics_(diagnostics) {}

  /// Returns nothing after an error; kind none if the table is absent.
  std::optional<model::ImpactDamping> damping(const model::LawType* law);
  std::optional<model::Friction> friction();

 private:
  std::optional<model::ImpactDamping> kelvin_voigt(const config::Parameters& p);
  std::optional<model::ImpactDamping> hunt_crossley(const config::Parameters& p);
  std::optional<model::ImpactDamping> jankowski(const config::Parameters& p);
  /// The restitution within (0, 1], and the key that must accompany it.
  std::optional<double> restitution(const config::Parameters& p, const char* companion);

  const config::Parameters& contact_;
  std::string path_, law_;
  config::Diagnostics& diagnostics_;
};

/// The damping ratio c/(2 sqrt(k m)) of a linear spring and dashpot for which a free impact of one
/// mass rebounds at `restitution` times its speed; the contact ends where the force is 0 or, if it
/// `pulls`, at g = 0.
BUTEE_EXPORT double kelvin_voigt_ratio(double restitution, bool pulls);
/// a v of Hunt and Crossley's damping for the given restitution after an impact at speed v, for
/// every n, k and m.
BUTEE_EXPORT double hunt_crossley_product(double restitution);
/// xi by Jankowski's formula, and the restitution that results from it, for every k, m and v with
/// n = 3/2.
BUTEE_EXPORT double jankowski_ratio(double restitution);
BUTEE_EXPORT double jankowski_restitution(double ratio);

}  // namespace butee::scene
