// What the header of an OpenEXR file promises, looked at before the library takes memory at its word.
#pragma once

#include <filesystem>

#include "renderer/error.h"

namespace lightwell {

/// kInvalidInput for an .exr whose header is cut off or has an attribute that is longer than the file; Done for all
/// else, files of other formats among them.
Status check_exr_header(const std::filesystem::path& path);

}  // namespace lightwell
