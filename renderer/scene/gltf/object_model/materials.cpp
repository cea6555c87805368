#include "renderer/scene/gltf/object_model/fields.h"

namespace lightwell::object_model {
namespace {

const auto material_at = [](auto& scene, std::size_t i) -> auto& {
  return scene.materials[i];
};

template <class Access>
Property material_field(std::string path, Access access, Range range = {}) {
  return field(material_at, std::move(path), access, range);
}

/// What a glTF textureInfo holds, with KHR_texture_transform.
void add_texture(std::vector<Property>& properties, const std::string& path, TextureUse Material::*use) {
  const std::string transform = path + "/extensions/KHR_texture_transform";
  properties.push_back(reference(
      material_at, path + "/index", [use](auto& material) -> auto& { return (material.*use).texture; }, textures));
  properties.push_back(material_field(
      path + "/texCoord", [use](auto& material) -> auto& { return (material.*use).uv_set; }, kUnit));
  properties.push_back(material_field(
      transform + "/offset", [use](auto& material) -> auto& { return (material.*use).offset; }));
  properties.push_back(material_field(
      transform + "/rotation", [use](auto& material) -> auto& { return (material.*use).rotation; }));
  properties.push_back(material_field(
      transform + "/scale", [use](auto& material) -> auto& { return (material.*use).scale; }));
}

/// KHR_materials_unlit: an empty object that is there or not.
Property unlit() {
  Property property;
  property.path = "/extensions/KHR_materials_unlit";
  property.get = [](const Scene& scene, std::size_t i) {
    return scene.materials[i].unlit ? std::optional<Json>(Json::object()) : std::nullopt;
  };
  property.set = [](Editing& editing, std::size_t i, const Json& value, const std::string& where) -> Status {
    if (value != Json::object()) return invalid_input(where, "must be an empty object, not " + in_words(value));
    editing.scene.materials[i].unlit = true;
    return Done{};
  };
  property.reset = [](Editing& editing, std::size_t i, const std::string&) -> Status {
    editing.scene.materials[i].unlit = false;
    return Done{};
  };
  return property;
}

std::vector<Property> core_properties() {
  const std::string metallic_roughness = "/pbrMetallicRoughness";
  std::vector<Property> properties{
      material_field("/name", &Material::name),
      material_field(metallic_roughness + "/baseColorFactor", &Material::base_color_factor, kUnit),
      material_field(metallic_roughness + "/metallicFactor", &Material::metallic_factor, kUnit),
      material_field(metallic_roughness + "/roughnessFactor", &Material::roughness_factor, kUnit),
      material_field("/emissiveFactor", &Material::emissive_factor, kUnit),
      material_field("/normalTexture/scale", &Material::normal_scale),
      material_field("/occlusionTexture/strength", &Material::occlusion_strength, kUnit),
      material_field("/alphaMode", &Material::alpha_mode),
      material_field("/alphaCutoff", &Material::alpha_cutoff, kNotNegative),
      material_field("/doubleSided", &Material::double_sided),
  };
  add_texture(properties, metallic_roughness + "/baseColorTexture", &Material::base_color_texture);
  add_texture(properties, metallic_roughness + "/metallicRoughnessTexture", &Material::metallic_roughness_texture);
  add_texture(properties, "/normalTexture", &Material::normal_texture);
  add_texture(properties, "/occlusionTexture", &Material::occlusion_texture);
  add_texture(properties, "/emissiveTexture", &Material::emissive_texture);
  return properties;
}

void add_extensions(std::vector<Property>& properties) {
  const auto add = [&](const std::string& path, auto member, Range range) {
    properties.push_back(material_field("/extensions/KHR_materials_" + path, member, range));
  };
  add("emissive_strength/emissiveStrength", &Material::emissive_strength, kNotNegative);
  add("ior/ior", &Material::ior, Range{1.0, 100.0});
  add("specular/specularFactor", &Material::specular_factor, kUnit);
  add("specular/specularColorFactor", &Material::specular_color_factor, kNotNegative);
  add("transmission/transmissionFactor", &Material::transmission_factor, kUnit);
  add("volume/thicknessFactor", &Material::thickness_factor, kNotNegative);
  add("volume/attenuationColor", &Material::attenuation_color, kUnit);
  add("clearcoat/clearcoatFactor", &Material::clearcoat_factor, kUnit);
  add("clearcoat/clearcoatRoughnessFactor", &Material::clearcoat_roughness, kUnit);
  add("sheen/sheenColorFactor", &Material::sheen_color_factor, kUnit);
  add("sheen/sheenRoughnessFactor", &Material::sheen_roughness, kUnit);
  add("clearcoat/clearcoatNormalTexture/scale", &Material::clearcoat_normal_scale, Range{});
  const auto add_use = [&](const std::string& path, TextureUse Material::*use) {
    add_texture(properties, "/extensions/KHR_materials_" + path, use);
  };
  add_use("specular/specularTexture", &Material::specular_texture);
  add_use("specular/specularColorTexture", &Material::specular_color_texture);
  add_use("transmission/transmissionTexture", &Material::transmission_texture);
  add_use("clearcoat/clearcoatTexture", &Material::clearcoat_texture);
  add_use("clearcoat/clearcoatRoughnessTexture", &Material::clearcoat_roughness_texture);
  add_use("clearcoat/clearcoatNormalTexture", &Material::clearcoat_normal_texture);
  add_use("sheen/sheenColorTexture", &Material::sheen_color_texture);
  add_use("sheen/sheenRoughnessTexture", &Material::sheen_roughness_texture);
  properties.push_back(absent_at_standard(material_field("/extensions/KHR_materials_volume/attenuationDistance",
                                                         &Material::attenuation_distance, kPositive)));
  properties.push_back(unlit());
}

}  // namespace

const ObjectKind& materials() {
  static const ObjectKind kind = [] {
    ObjectKind materials;
    materials.singular = "material";
    materials.pointer = "/materials";
    materials.properties = core_properties();
    add_extensions(materials.properties);
    materials.count = [](const Scene& scene) { return scene.materials.size(); };
    materials.name = [](const Scene& scene, std::size_t i) -> const std::string& { return scene.materials[i].name; };
    materials.insert = insert_material;
    materials.erase = erase_material;
    materials.most = &EditLimits::max_materials;
    return materials;
  }();
  return kind;
}

}  // namespace lightwell::object_model
