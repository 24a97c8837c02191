#pragma once

#include <optional>

#include <butee/model/output_request.hpp>
#include <butee/plugin/catalogue.hpp>

#include "table.hpp"

namespace butee::app::plot {

/// A wall in the plane (uy, uz) that a node may touch, to ground.
struct Wall {
  bool is_circle = true;
  double y = 0.0, z = 0.0;  ///< the centre of a circle, m; the normal of a straight wall
  double distance = 0.0;    ///< m, the radius of a circle; of a straight wall from the origin along its normal
};

/// A probe of a run, as far as pictures need it.
struct Probe {
  std::string label;
  std::vector<double> gaps;      ///< m: where u meets a stop to ground; ascending, negative ones on the other side
  std::vector<double> gaps_z{};  ///< m: the same of w
  std::vector<Wall> walls{};
};

/// Where a contact is.
struct ContactPlace {
  std::string node;  ///< as impacts.csv and wear.csv name it
  double x;          ///< m, along x; its number where the contacts do not stand along x
};

/// What a result folder of `butee run` holds.
struct Result {
  std::string folder;
  std::string label;  ///< its name in a legend
  std::string title;  ///< of the scene
  Table history;      ///< empty where the run kept fields alone
  std::optional<Table> energy;
  std::vector<Probe> probes;                 ///< in the order of the columns
  std::vector<double> frequencies;           ///< Hz, of the harmonic loads
  std::vector<double> speeds;                ///< rad/s, of [rotation] at the times of the history, where it varies
  std::string field_format;                  ///< of the fields, "" where there are none
  std::vector<ContactPlace> contact_places;  ///< of all contacts of the scene
  bool contacts_along_x = false;             ///< they stand on beams along x

  /// The column "probe.quantity", or nullptr.
  const std::vector<double>* column(const std::string& probe, const std::string& quantity) const {
    return history.find(probe + "." + quantity);
  }
};

/// Reads a folder. Throws InputError where it holds no results.
Result read_result(const std::string& folder, const plugin::Catalogue& catalogue, Window window);

/// Makes the labels of several results differ.
void make_labels_unique(std::vector<Result>& results);

}  // namespace butee::app::plot
