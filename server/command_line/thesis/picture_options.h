// The options of all commands that make the thesis' pictures again.
#pragma once

#include <string>

#include "renderer/renderer.h"

namespace CLI {
class App;
}

namespace lightwell {

/// Adds --side, what tables and figures leave open of the light, --device and --tracer.
void add_picture_options(CLI::App& app, int& side_px, Settings& settings, std::string& device, std::string& tracer);

/// The first of these that is out of range, by its option.
Status check_picture_options(int side_px, const Settings& settings);

}  // namespace lightwell
