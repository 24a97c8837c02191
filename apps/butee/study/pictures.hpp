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

/// Draws them into DIR/plots; the files. Throws RunError where gnuplot cannot.
std::vector<std::string> draw_study(const study::Study& study, const study::Layout& layout, const study::Store& store,
                                    const std::vector<std::string>& formats);

}  // namespace butee::app::studies
