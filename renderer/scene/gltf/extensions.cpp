#include "renderer/scene/gltf/extensions.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace lightwell::gltf {
namespace {

constexpr std::array<std::string_view, 13> kKnown{
    "EXT_mesh_gpu_instancing", "KHR_lights_punctual",  "KHR_materials_clearcoat", "KHR_materials_emissive_strength",
    "KHR_materials_ior",       "KHR_materials_sheen",  "KHR_materials_specular",  "KHR_materials_transmission",
    "KHR_materials_unlit",     "KHR_materials_volume", "KHR_mesh_quantization",   "KHR_node_visibility",
    "KHR_texture_transform",
};

bool is_known(std::string_view name) {
  return std::find(kKnown.begin(), kKnown.end(), name) != kKnown.end();
}

}  // namespace

void check_extensions(const std::vector<std::string>& used, const std::vector<std::string>& required,
                      Warnings& warnings) {
  for (std::size_t i = 0; i < required.size(); ++i)
    if (!is_known(required[i]))
      fail(join("extensionsRequired", i), "the extension " + in_quotes(required[i]) + " is not supported",
           ErrorKind::kUnsupported);
  for (const std::string& name : used)
    if (!is_known(name)) warnings.add_once("extensionsUsed", "the extension " + in_quotes(name) + " is ignored");
}

}  // namespace lightwell::gltf
