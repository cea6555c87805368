// The names that the protocol's own enumerations have on the wire, and what a scene may be called.
#pragma once

#include <optional>
#include <string_view>

#include "protocol/messages.h"

namespace lightwell::protocol {

/// 1 to 64 of [a-z0-9_-].
bool is_scene_name(std::string_view name);

std::string_view name_of(ImageFormat format);  // "png", "jpeg", "exr"
std::string_view name_of(Role role);           // "driver", "viewer"
std::optional<ImageFormat> image_format_from_name(std::string_view name);
std::optional<Role> role_from_name(std::string_view name);

/// The Content-Type of a picture.
std::string_view media_type_of(ImageFormat format);

}  // namespace lightwell::protocol
