// How a picture is made: the options that `serve` and `render` share.
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

/// Adds --device and --tracer.
void add_device_options(CLI::App& app, std::string& device, std::string& tracer);

}  // namespace lightwell
