#pragma once

#include <optional>

#include <butee/model/output_request.hpp>
#include <butee/plugin/catalogue.hpp>

#include "table.hpp"

namespace butee::app::plot {

/// A probe of a run, as far as pictures need it.
struct Probe {
  std::string label;
  std::vector<double> gaps;  ///< m: where u meets a stop to ground; ascending, negative ones on the other side
};

/// What a result folder of `butee run` holds.
struct Result {
  std::string folder;
  std::string label;  ///< its name in a legend
  std::string title;  ///< of the scene
  Table history;      ///< empty where the run kept fields alone
  std::optional<Table> energy;
  std::vector<Probe> probes;        ///< in the order of the columns
  std::vector<double> frequencies;  ///< Hz, of the harmonic loads
  std::vector<double> speeds;       ///< rad/s, of [rotation] at the times of the history, where it varies
  std::string field_format;         ///< of the fields, "" where there are none

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
