// How a picture is made: the options that the commands share.
#pragma once

#include <string>

#include "renderer/renderer.h"

namespace CLI {
class App;
}

namespace lightwell {

/// Adds --method, --samples, --bounces and the other members of Settings. `settings` must outlive the
/// parsing. Options that are added to `app` later fall into this function's last group unless another one is set.
void add_settings_options(CLI::App& app, Settings& settings);

/// The part of them that tables and figures of the thesis leave open: all of its light but the method, the samples and
/// the indirect map's size.
void add_thesis_options(CLI::App& app, Settings& settings);

/// Adds --device and --tracer.
void add_device_options(CLI::App& app, std::string& device, std::string& tracer);

}  // namespace lightwell
