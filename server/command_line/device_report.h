// Devices as JSON and as text.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "renderer/gl/device.h"

namespace lightwell {

/// index (null for Mesa's surfaceless platform), egl_name, gl_renderer, gl_version, software, usable, reason.
nlohmann::json to_json(const gl::DeviceInfo& device);

/// "0: device /dev/dri/card0", "-: Mesa surfaceless platform".
std::string short_name(const gl::DeviceInfo& device);

}  // namespace lightwell
