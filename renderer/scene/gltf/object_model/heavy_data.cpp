// Kinds whose data is heavy and shared: they are named, and meshes are given materials.
#include "renderer/scene/gltf/object_model/object_kind.h"
#include "renderer/scene/gltf/object_model/pointer.h"

namespace lightwell::object_model {
namespace {

/// `/primitives/{index}/material`; none if `path` is something else or there is no such primitive.
std::optional<Property> primitive_material(const Scene& scene, std::size_t mesh, std::string_view path) {
  constexpr std::string_view kBefore = "/primitives/", kAfter = "/material";
  if (!path.starts_with(kBefore) || !path.ends_with(kAfter) || path.size() <= kBefore.size() + kAfter.size())
    return std::nullopt;
  const std::optional<std::size_t> index =
      index_of_token(path.substr(kBefore.size(), path.size() - kBefore.size() - kAfter.size()));
  if (!index || *index >= scene.meshes[mesh]->primitives.size()) return std::nullopt;

  Property property;
  property.path = path;
  property.get = [index](const Scene& in, std::size_t i) {
    const int material = in.meshes[i]->primitives[*index].material;
    return material < 0 ? std::nullopt : std::optional<Json>(material);
  };
  property.set = [index](Editing& editing, std::size_t i, const Json& value, const std::string& where) -> Status {
    const Result<int> material = read_reference(editing, materials(), value, where);
    if (!material) return material.error();
    editing.mesh_for_writing(i).primitives[*index].material = *material;
    return Done{};
  };
  property.reset = [index](Editing& editing, std::size_t i, const std::string&) -> Status {
    editing.mesh_for_writing(i).primitives[*index].material = -1;
    return Done{};
  };
  return property;
}

}  // namespace

const ObjectKind& meshes() {
  static const ObjectKind kind = [] {
    ObjectKind meshes;
    meshes.singular = "mesh";
    meshes.pointer = "/meshes";
    meshes.indexed_property = primitive_material;
    meshes.count = [](const Scene& scene) { return scene.meshes.size(); };
    meshes.name = [](const Scene& scene, std::size_t i) -> const std::string& { return scene.meshes[i]->name; };
    return meshes;
  }();
  return kind;
}

const ObjectKind& skins() {
  static const ObjectKind kind = [] {
    ObjectKind skins;
    skins.singular = "skin";
    skins.pointer = "/skins";
    skins.count = [](const Scene& scene) { return scene.skins.size(); };
    skins.name = [](const Scene& scene, std::size_t i) -> const std::string& { return scene.skins[i].name; };
    return skins;
  }();
  return kind;
}

const ObjectKind& textures() {
  static const ObjectKind kind = [] {
    ObjectKind textures;
    textures.singular = "texture";
    textures.pointer = "/textures";
    textures.count = [](const Scene& scene) { return scene.textures.size(); };
    textures.name = [](const Scene& scene, std::size_t i) -> const std::string& { return scene.textures[i].name; };
    return textures;
  }();
  return kind;
}

}  // namespace lightwell::object_model
