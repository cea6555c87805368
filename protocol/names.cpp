#include "protocol/names.h"

#include <algorithm>

namespace lightwell::protocol {

bool is_scene_name(std::string_view name) {
  return !name.empty() && name.size() <= 64 && std::all_of(name.begin(), name.end(), [](char letter) {
    return (letter >= 'a' && letter <= 'z') || (letter >= '0' && letter <= '9') || letter == '_' || letter == '-';
  });
}

std::string_view name_of(ImageFormat format) {
  switch (format) {
    case ImageFormat::kPng:
      return "png";
    case ImageFormat::kJpeg:
      return "jpeg";
    case ImageFormat::kExr:
      return "exr";
  }
  return {};
}

std::string_view name_of(Role role) {
  return role == Role::kDriver ? "driver" : "viewer";
}

std::optional<ImageFormat> image_format_from_name(std::string_view name) {
  for (const ImageFormat format : {ImageFormat::kPng, ImageFormat::kJpeg, ImageFormat::kExr})
    if (name_of(format) == name) return format;
  return std::nullopt;
}

std::optional<Role> role_from_name(std::string_view name) {
  for (const Role role : {Role::kDriver, Role::kViewer})
    if (name_of(role) == name) return role;
  return std::nullopt;
}

std::string_view media_type_of(ImageFormat format) {
  switch (format) {
    case ImageFormat::kPng:
      return "image/png";
    case ImageFormat::kJpeg:
      return "image/jpeg";
    case ImageFormat::kExr:
      return "image/x-exr";
  }
  return {};
}

}  // namespace lightwell::protocol
