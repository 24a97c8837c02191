#pragma once

#include <string>
#include <vector>

#include <butee/study/store.hpp>

#include "../plot/chart.hpp"

namespace butee::app::studies {

/// Pictures of a study's rows: bifurcation diagrams and response curves over one key, maps over two keys,
/// Poincare sections if sections of u and v of a probe were collected, and histograms for random plans.
std::vector<plot::Picture> study_pictures(const study::Study& study, const study::Layout& layout,
                                          const study::Store& store);

/// Draws them into `to` (empty: DIR/plots) and returns the written files. Throws RunError if gnuplot fails.
std::vector<std::string> draw_study(const study::Study& study, const study::Layout& layout, const study::Store& store,
                                    const std::vector<std::string>& formats, const std::string& to = "");
/// As above for the folder of a study, from the rows that exist so far.
std::vector<std::string> draw_folder(const std::string& folder, const std::string& to,
                                     const std::vector<std::string>& formats);

}  // namespace butee::app::studies
