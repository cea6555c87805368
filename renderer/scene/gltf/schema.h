// The JSON of glTF 2.0 as far as the loader knows it: which members each object has, and of what type they are.
#pragma once

#include <nlohmann/json.hpp>

namespace lightwell::gltf {

/// Checks the whole document and leaves only what the loader knows in it: no extras, no unknown extension, no unknown
/// member. Every index, count and offset is a whole number from 0 to 2^31 - 1, every array of numbers has the length
/// it must have, every required member is there. Throws Failure naming the member otherwise.
void apply_schema(nlohmann::json& document);

}  // namespace lightwell::gltf
