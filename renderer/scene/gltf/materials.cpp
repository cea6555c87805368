#include "renderer/scene/gltf/materials.h"

#include <array>

#include "renderer/scene/gltf/numbers.h"

namespace lightwell::gltf {
namespace {

// Beyond it, sums and squares of light leave the range of a float.
constexpr double kMostLight = 1e15;

Wrap read_wrap(Context& context, int value, const std::string& where) {
  switch (value) {
    case TINYGLTF_TEXTURE_WRAP_REPEAT:
      return Wrap::kRepeat;
    case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
      return Wrap::kMirroredRepeat;
    case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
      return Wrap::kClampToEdge;
    default:
      context.warnings.add(where, std::to_string(value) + " is not a wrap mode; repeated");
      return Wrap::kRepeat;
  }
}

Sampler read_sampler(Context& context, int index, const std::string& where) {
  if (index == kNone) return {};
  const tinygltf::Sampler& source = at(context.document.model.samplers, index, join(where, "sampler"));
  const std::string path = join("samplers", static_cast<std::size_t>(index));
  const int minification = source.minFilter;
  Sampler sampler;
  sampler.mag_nearest = source.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
  sampler.min_nearest = minification == TINYGLTF_TEXTURE_FILTER_NEAREST ||
                        minification == TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST ||
                        minification == TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_LINEAR;
  sampler.mipmapped = minification != TINYGLTF_TEXTURE_FILTER_NEAREST && minification != TINYGLTF_TEXTURE_FILTER_LINEAR;
  sampler.wrap_s = read_wrap(context, source.wrapS, join(path, "wrapS"));
  sampler.wrap_t = read_wrap(context, source.wrapT, join(path, "wrapT"));
  return sampler;
}

void read_textures(Context& context, Scene& scene) {
  const std::vector<tinygltf::Texture>& textures = context.document.model.textures;
  for (std::size_t i = 0; i < textures.size(); ++i) {
    const std::string where = join("textures", i);
    if (textures[i].source != kNone) at(context.document.images, textures[i].source, join(where, "source"));
    scene.textures.push_back({textures[i].name, textures[i].source, read_sampler(context, textures[i].sampler, where)});
  }
}

glm::vec2 vector_or(const tinygltf::Value& object, const char* name, glm::vec2 fallback) {
  if (!object.Has(name)) return fallback;
  const tinygltf::Value& array = object.Get(name);
  return {to_float(array.Get(0).GetNumberAsDouble()), to_float(array.Get(1).GetNumberAsDouble())};
}

glm::vec3 color_or(Context& context, const tinygltf::Value& object, const char* name, glm::vec3 fallback, double most,
                   const std::string& where) {
  if (!object.Has(name)) return fallback;
  std::vector<double> values;
  for (int i = 0; i < 3; ++i) values.push_back(object.Get(name).Get(i).GetNumberAsDouble());
  return clamped_vector<glm::vec3>(context, values, 0.0, most, where, name);
}

/// The three kinds of texture reference differ in one member only, which is read apart.
template <class TextureInfo>
TextureUse read_use(Context& context, const Scene& scene, const TextureInfo& info, const std::string& where) {
  TextureUse use;
  if (info.index == kNone) return use;
  if (at(scene.textures, info.index, join(where, "index")).image == kNone) {
    context.warnings.add(where, "the texture has no image and is ignored");
    return use;
  }
  use.texture = info.index;
  use.uv_set = info.texCoord;
  if (const tinygltf::Value* transform = find_extension(info.extensions, "KHR_texture_transform")) {
    use.offset = vector_or(*transform, "offset", use.offset);
    use.rotation = to_float(number_or(*transform, "rotation", 0.0));
    use.scale = vector_or(*transform, "scale", use.scale);
    use.uv_set = index_or(*transform, "texCoord", use.uv_set);
  }
  if (use.uv_set > 1) {
    context.warnings.add(where, "texture coordinates " + std::to_string(use.uv_set) + " are not read; 0 are used");
    use.uv_set = 0;
  }
  return use;
}

/// A textureInfo within an extension, which tinygltf leaves as a plain value.
TextureUse read_use(Context& context, const Scene& scene, const tinygltf::Value& extension, const char* name,
                    const std::string& where) {
  if (!extension.Has(name)) return {};
  const tinygltf::Value& source = extension.Get(name);
  tinygltf::TextureInfo info;
  info.index = index_or(source, "index", kNone);
  info.texCoord = index_or(source, "texCoord", 0);
  if (source.Has("extensions")) {
    const tinygltf::Value& extensions = source.Get("extensions");
    for (const std::string& key : extensions.Keys()) info.extensions[key] = extensions.Get(key);
  }
  return read_use(context, scene, info, join(where, name));
}

AlphaMode read_alpha_mode(Context& context, const std::string& mode, const std::string& where) {
  if (mode == "MASK") return AlphaMode::kMask;
  if (mode == "BLEND") return AlphaMode::kBlend;
  if (mode != "OPAQUE") context.warnings.add(where, "alphaMode " + in_quotes(mode) + " is unknown; opaque");
  return AlphaMode::kOpaque;
}

void read_core(Context& context, const Scene& scene, const tinygltf::Material& source, const std::string& where,
               Material& material) {
  const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
  const std::string pbr_path = join(where, "pbrMetallicRoughness");
  material.base_color_factor =
      clamped_vector<glm::vec4>(context, pbr.baseColorFactor, 0.0, 1.0, pbr_path, "baseColorFactor");
  material.metallic_factor = clamped(context, pbr.metallicFactor, 0.0, 1.0, pbr_path, "metallicFactor");
  material.roughness_factor = clamped(context, pbr.roughnessFactor, 0.0, 1.0, pbr_path, "roughnessFactor");
  material.emissive_factor =
      clamped_vector<glm::vec3>(context, source.emissiveFactor, 0.0, 1.0, where, "emissiveFactor");
  material.normal_scale =
      clamped(context, source.normalTexture.scale, -kMaxFloat, kMaxFloat, where, "normalTexture/scale");
  material.occlusion_strength =
      clamped(context, source.occlusionTexture.strength, 0.0, 1.0, where, "occlusionTexture/strength");
  material.alpha_mode = read_alpha_mode(context, source.alphaMode, where);
  material.alpha_cutoff = clamped(context, source.alphaCutoff, 0.0, kMaxFloat, where, "alphaCutoff");
  material.double_sided = source.doubleSided;

  const auto use = [&](const auto& info, const std::string& parent, const char* name) {
    return read_use(context, scene, info, join(parent, name));
  };
  material.base_color_texture = use(pbr.baseColorTexture, pbr_path, "baseColorTexture");
  material.metallic_roughness_texture = use(pbr.metallicRoughnessTexture, pbr_path, "metallicRoughnessTexture");
  material.normal_texture = use(source.normalTexture, where, "normalTexture");
  material.occlusion_texture = use(source.occlusionTexture, where, "occlusionTexture");
  material.emissive_texture = use(source.emissiveTexture, where, "emissiveTexture");
}

void read_extensions(Context& context, const Scene& scene, const tinygltf::Material& source, const std::string& where,
                     Material& material) {
  /// Calls `read(extension, path)` if the material has the extension.
  const auto with = [&](const char* name, auto read) {
    const tinygltf::Value* extension = find_extension(source.extensions, name);
    if (!extension) return;
    const std::string path = join(join(where, "extensions"), name);
    read(*extension, path);
  };
  const auto factor = [&](const tinygltf::Value& extension, const char* name, double fallback, double most,
                          const std::string& path) {
    return clamped(context, number_or(extension, name, fallback), 0.0, most, path, name);
  };
  const auto use = [&](const tinygltf::Value& extension, const char* name, const std::string& path) {
    return read_use(context, scene, extension, name, path);
  };
  with("KHR_materials_unlit", [&](const auto&, const auto&) { material.unlit = true; });
  with("KHR_materials_emissive_strength", [&](const auto& extension, const auto& path) {
    material.emissive_strength = factor(extension, "emissiveStrength", 1.0, kMostLight, path);
  });
  with("KHR_materials_ior", [&](const auto& extension, const auto& path) {
    // 0 is legal: a mirror at grazing angles and all others alike.
    const double ior = number_or(extension, "ior", 1.5);
    material.ior = ior == 0.0 ? 0.0f : clamped(context, ior, 1.0, kMaxFloat, path, "ior");
  });
  with("KHR_materials_specular", [&](const auto& extension, const auto& path) {
    material.specular_factor = factor(extension, "specularFactor", 1.0, 1.0, path);
    material.specular_color_factor =
        color_or(context, extension, "specularColorFactor", glm::vec3(1.0f), kMaxFloat, path);
    material.specular_texture = use(extension, "specularTexture", path);
    material.specular_color_texture = use(extension, "specularColorTexture", path);
  });
  with("KHR_materials_transmission", [&](const auto& extension, const auto& path) {
    material.transmission_factor = factor(extension, "transmissionFactor", 0.0, 1.0, path);
    material.transmission_texture = use(extension, "transmissionTexture", path);
  });
  with("KHR_materials_volume", [&](const auto& extension, const auto& path) {
    material.thickness_factor = factor(extension, "thicknessFactor", 0.0, kMaxFloat, path);
    material.attenuation_distance = factor(extension, "attenuationDistance", 0.0, kMaxFloat, path);
    material.attenuation_color = color_or(context, extension, "attenuationColor", glm::vec3(1.0f), 1.0, path);
  });
  with("KHR_materials_clearcoat", [&](const auto& extension, const auto& path) {
    material.clearcoat_factor = factor(extension, "clearcoatFactor", 0.0, 1.0, path);
    material.clearcoat_roughness = factor(extension, "clearcoatRoughnessFactor", 0.0, 1.0, path);
    material.clearcoat_texture = use(extension, "clearcoatTexture", path);
    material.clearcoat_roughness_texture = use(extension, "clearcoatRoughnessTexture", path);
    material.clearcoat_normal_texture = use(extension, "clearcoatNormalTexture", path);
    if (extension.Has("clearcoatNormalTexture"))
      material.clearcoat_normal_scale =
          clamped(context, number_or(extension.Get("clearcoatNormalTexture"), "scale", 1.0), -kMaxFloat, kMaxFloat,
                  path, "clearcoatNormalTexture/scale");
  });
  with("KHR_materials_sheen", [&](const auto& extension, const auto& path) {
    material.sheen_color_factor = color_or(context, extension, "sheenColorFactor", glm::vec3(0.0f), 1.0, path);
    material.sheen_roughness = factor(extension, "sheenRoughnessFactor", 0.0, 1.0, path);
    material.sheen_color_texture = use(extension, "sheenColorTexture", path);
    material.sheen_roughness_texture = use(extension, "sheenRoughnessTexture", path);
  });
}

}  // namespace

void read_materials(Context& context, Scene& scene) {
  read_textures(context, scene);
  const std::vector<tinygltf::Material>& materials = context.document.model.materials;
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const std::string where = join("materials", i);
    Material material;
    material.name = materials[i].name;
    read_core(context, scene, materials[i], where, material);
    read_extensions(context, scene, materials[i], where, material);
    scene.materials.push_back(std::move(material));
  }
}

}  // namespace lightwell::gltf
