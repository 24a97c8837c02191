#pragma once

#include <string>
#include <vector>

#include <butee/study/store.hpp>

#include "../plot/chart.hpp"

namespace butee::app::studies {

/// The pictures of a study's rows: bifurcation diagrams and response curves over one key, maps over two,
/// Poincare sections where sections of u and v of a probe were collected, histograms of plans that are spread at
/// random.
std::vector<plot::Picture> study_pictures(const study::Study& study, const study::Layout& layout,
                                          const study::Store& store);

/// Draws them into `to`, DIR/plots where that is empty; the files. Throws RunError where gnuplot cannot.
std::vector<std::string> draw_study(const study::Study& study, const study::Layout& layout, const study::Store& store,
                                    const std::vector<std::string>& formats, const std::string& to = "");
/// The same of the folder of a study, of the rows that are there.
std::vector<std::string> draw_folder(const std::string& folder, const std::string& to,
                                     const std::vector<std::string>& formats);

}  // namespace butee::app::studies
