// What `lightwell bench thesis` found, as curves.
#pragma once

#include <vector>

#include "server/command_line/svg_plot.h"
#include "server/command_line/thesis/measurement.h"

namespace lightwell {

/// Frames a second over samples, ours beside the printed ones, one plot a table; and the time of a frame over the
/// number of triangles. What was not measured has no plot.
std::vector<Plot> plots_of(const ThesisBench& bench);

}  // namespace lightwell
