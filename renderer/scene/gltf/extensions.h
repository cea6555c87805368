// Which extensions of glTF the loader honours.
#pragma once

#include <string>
#include <vector>

#include "renderer/scene/gltf/diagnostics.h"

namespace lightwell::gltf {

/// Throws Failure with kUnsupported if an extension is required that the loader does not know; warns of unknown ones
/// that are merely used.
void check_extensions(const std::vector<std::string>& used, const std::vector<std::string>& required,
                      Warnings& warnings);

}  // namespace lightwell::gltf
