#pragma once

#include <optional>

#include <butee/model/output_request.hpp>
#include <butee/plugin/catalogue.hpp>

#include "table.hpp"

namespace butee::app::plot {

/// An obstacle to ground in the plane (uy, uz) that a node can touch.
struct Wall {
  bool is_circle = true;
  double y = 0.0, z = 0.0;  ///< centre of a circle, m; unit normal of a straight wall
  double distance = 0.0;    ///< m; radius of a circle; distance of a straight wall from the origin along its normal
};

/// A probe of a run, with the data that pictures need.
struct Probe {
  std::string label;
  std::vector<model::Quantity> quantities;
  std::vector<double> gaps;      ///< m: u at contact with stops to ground; ascending, negative on the negative side
  std::vector<double> gaps_z{};  ///< m: the same for w
  std::vector<Wall> walls{};
};

/// The position of a contact.
struct ContactPlace {
  std::string node;  ///< the name used in impacts.csv and wear.csv
  double x;          ///< m, along x; the contact's number if the contacts do not lie along x
};

/// The contents of a result folder of `butee run`.
struct Result {
  std::string folder;
  std::string label;  ///< its name in a legend
  std::string title;  ///< title of the scene
  Table history;      ///< empty if the run kept only fields
  std::optional<Table> energy;
  std::vector<Probe> probes;                 ///< in the order of the columns
  std::vector<double> frequencies;           ///< Hz, frequencies of the harmonic loads
  std::vector<double> speeds;                ///< rad/s, of [rotation] at the times of the history, if it varies
  std::string field_format;                  ///< format of the fields; "" if there are none
  std::vector<ContactPlace> contact_places;  ///< for all contacts of the scene
  bool contacts_along_x = false;             ///< the contacts lie on beams along x

  /// The column "probe.quantity", under either of the quantity's names (u or uy), or nullptr.
  const std::vector<double>* column(const std::string& probe, const std::string& quantity) const;
};

/// Reads a folder. Throws InputError if it contains no results.
Result read_result(const std::string& folder, const plugin::Catalogue& catalogue, Window window);

/// Makes the labels of several results unique.
void make_labels_unique(std::vector<Result>& results);

}  // namespace butee::app::plot
