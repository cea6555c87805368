// What `lightwell bench thesis` found, as text and as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "server/command_line/thesis/measurement.h"

namespace lightwell {

/// Columns as wide as their widest cell, two spaces apart, numbers to the right; the first line holds the titles. Every
/// line has as many cells as the first.
std::string aligned(const std::vector<std::vector<std::string>>& lines);

/// The machine, each table beside the printed figures, and the cost against the number of triangles.
std::string text_report(const ThesisBench& bench);

/// The same; rates in rays a second, times in milliseconds.
nlohmann::json json_report(const ThesisBench& bench);

}  // namespace lightwell
