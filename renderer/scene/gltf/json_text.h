// JSON text into a value, within bounds.
#pragma once

#include <nlohmann/json.hpp>
#include <string_view>

namespace lightwell::gltf {

/// Throws Failure with kInvalidInput for what is not JSON, with kTooLarge for what is nested too deeply or has too many
/// values; this is found out before any value is made.
nlohmann::json parse_json(std::string_view text);

}  // namespace lightwell::gltf
