// A small glTF file in which every kind of object that the loader reads is found once.
#pragma once

#include "tests/unit/gltf_builder.h"

namespace lightwell {

/// A file with something of everything, to be broken.
inline GltfBuilder rich_gltf() {
  GltfBuilder builder = GltfBuilder::triangle();
  nlohmann::json& attributes = builder.primitive()["attributes"];
  attributes["NORMAL"] = builder.add_accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  attributes["TEXCOORD_0"] = builder.add_accessor<float>({0, 1, 1, 1, 0, 0}, "VEC2");
  attributes["COLOR_0"] = builder.add_accessor<std::uint8_t>({255, 0, 0, 0, 255, 0, 0, 0, 255}, "VEC3", true);
  attributes["JOINTS_0"] = builder.add_accessor<std::uint8_t>({0, 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
  attributes["WEIGHTS_0"] = builder.add_accessor<float>({0.5f, 0.5f, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
  builder.primitive()["indices"] = builder.add_accessor<std::uint16_t>({0, 1, 2}, "SCALAR");
  builder.primitive()["targets"] = {{{"POSITION", builder.add_accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3")}}};
  builder.primitive()["material"] = 0;
  builder.add("samplers", {{"minFilter", 9987}});
  builder.add_texture();
  builder.root["textures"][0]["sampler"] = 0;
  builder.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
                            {"normalTexture", {{"index", 0}}},
                            {"extensions", {{"KHR_materials_ior", {{"ior", 1.4}}}}}});
  builder.add("nodes", {{"translation", {0, 1, 0}}});
  builder.add("nodes", {{"rotation", {0, 0, 0, 1}}, {"children", {1}}});
  const std::vector<float> identity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  std::vector<float> matrices = identity;
  matrices.insert(matrices.end(), identity.begin(), identity.end());
  builder.add("skins", {{"joints", {1, 2}}, {"inverseBindMatrices", builder.add_accessor<float>(matrices, "MAT4")}});
  builder.root["nodes"][0]["skin"] = 0;
  builder.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.25}}}});
  builder.root["nodes"][1]["camera"] = 0;
  builder.root["extensionsUsed"] = {"KHR_lights_punctual", "EXT_mesh_gpu_instancing"};
  builder.root["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "spot"}, {"spot", nlohmann::json::object()}}};
  builder.root["nodes"][2]["extensions"]["KHR_lights_punctual"]["light"] = 0;
  const int instances = builder.add_accessor<float>({0, 0, 0, 1, 1, 1}, "VEC3");
  builder.add("nodes", {{"mesh", 0}});
  builder.root["nodes"][3]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = instances;
  builder.root["scenes"] = {{{"nodes", {0, 2, 3}}}};
  builder.root["scene"] = 0;
  builder.add("animations",
              {{"samplers", {{{"input", builder.add_accessor<float>({0, 1}, "SCALAR")}, {"output", instances}}}},
               {"channels", {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "translation"}}}}}}});
  return builder;
}

}  // namespace lightwell
