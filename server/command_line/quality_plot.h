// Error against milliseconds as an SVG picture.
#pragma once

#include <string>
#include <vector>

#include "server/command_line/quality_table.h"

namespace lightwell {

/// A panel for each scene, both axes logarithmic, a line for each series.
std::string quality_svg(const std::vector<SceneQuality>& scenes);

}  // namespace lightwell
