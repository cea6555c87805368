// Pictures on their way to a file whose ending says what they are.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "renderer/error.h"
#include "renderer/renderer.h"

namespace lightwell {

enum class OutputFormat { kExr, kPng, kJpeg };

/// By the ending: .exr, .png, .jpg or .jpeg, in any case.
std::optional<OutputFormat> output_format_of(const std::filesystem::path& path);

/// Whether files of this ending hold light itself (.exr, .hdr) and not what a display shows.
bool is_scene_referred(const std::filesystem::path& path);

/// kInternal if the path's folder does not exist: found out before long work, not after it.
Status check_folder_of(const std::filesystem::path& path);

/// .exr: the frame's linear light with `metadata` in the header; else what a display shows. The frame must hold it.
Status write_frame(const std::filesystem::path& path, const Frame& frame,
                   const std::map<std::string, std::string>& metadata);

}  // namespace lightwell
