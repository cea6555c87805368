#include "renderer/passes/device_scene.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "renderer/check.h"
#include "renderer/passes/bindings.glsl"
#include "renderer/passes/device_types.h"

namespace lightwell {

namespace {

constexpr std::size_t kKeptScenes = 8;

// Whether any of its surface may be, see kSmoothAlpha in shaders/smooth_lobe.glsl: textures only make it smoother.
bool may_be_smooth(const DeviceMaterial& material) {
  constexpr float kSmoothRoughness = 0.25f;
  const bool textured = material.metallic_roughness_texture.slot != 0;
  return (textured || material.roughness < kSmoothRoughness) &&
         (material.specular_factor > 0.0f || material.metallic > 0.0f);
}

}  // namespace

DeviceScene::DeviceScene(gl::ShaderLibrary& shaders, gl::BufferUse buffers)
    : instances_("instances", 0, buffers),
      materials_("materials", 0, buffers),
      draw_commands_("draws", 0),
      position_texels_("positions", GL_RGB32F),
      vertex_texels_("vertices", GL_RGBA32UI),
      triangle_texels_("triangles", GL_RGBA32UI),
      instance_texels_("instances", GL_RGBA32UI),
      material_texels_("materials", GL_RGBA32UI),
      shaders_(shaders),
      buffers_(buffers) {
  glCreateVertexArrays(1, &vertex_array_);
}

DeviceScene::~DeviceScene() {
  glDeleteVertexArrays(1, &vertex_array_);
}

void DeviceScene::prepare(const Scene& scene, const Pose& pose, bool multiple_scattering) {
  use_geometry(pose);
  use_textures(scene);
  upload_materials(scene);
  const std::vector<DeformTask> deformed = place_instances(pose);
  upload_instances(scene, pose);
  environment_ = scene.environment;
  set_defines(scene, pose, multiple_scattering);
  attach_buffers();
  if (!deformed.empty()) deform(deformed);
  set_vertex_array();
}

void DeviceScene::set_defines(const Scene& scene, const Pose& pose, bool multiple_scattering) {
  const bool points = std::any_of(pose.lights.begin(), pose.lights.end(),
                                  [](const PlacedLight& placed) { return placed.light.kind == LightKind::kPoint; });
  texture_defines_.clear();
  // What has lobes is rare enough to be spared variants of its own without textures.
  if (has_textures_ || has_all_textures_ || has_lobes_) {
    const SceneTextures& textures = *textures_.front();
    texture_defines_ = {"HAS_TEXTURES 1", "COLOR_CLASSES " + std::to_string(textures.size_classes(true)),
                        "DATA_CLASSES " + std::to_string(textures.size_classes(false))};
  }
  if (has_all_textures_ || has_lobes_) texture_defines_.emplace_back("ALL_TEXTURES 1");
  lobe_defines_.clear();
  if (has_lobes_) lobe_defines_.emplace_back("HAS_LOBES 1");
  light_defines_ = {pose.lights.size() > 2    ? "MANY_LIGHTS 1"
                    : pose.lights.size() == 2 ? "TWO_LIGHTS 1"
                                              : "ONE_LIGHT 1"};
  if (points) light_defines_.emplace_back("POINT_LIGHTS 1");
  if (has_tinted_shadows()) light_defines_.emplace_back("TINTED_SHADOWS 1");
  brdf_defines_ = lobe_defines_;
  if (multiple_scattering) brdf_defines_.emplace_back("MULTISCATTER 1");
  is_lambert_ = !has_lobes_ && std::all_of(pose.instances.begin(), pose.instances.end(), [&](const Instance& instance) {
    return instance.material >= 0 &&
           lightwell::is_lambert(scene.materials[static_cast<std::size_t>(instance.material)]);
  });
  smooth_defines_.clear();
  if (has_smooth_) smooth_defines_.emplace_back("SMOOTH_SURFACES 1");
  environment_defines_.clear();
  if (scene.environment.image) environment_defines_.emplace_back("HAS_ENVIRONMENT_IMAGE 1");
}

void DeviceScene::attach_buffers() {
  position_texels_.attach(geometries_.front()->positions());
  vertex_texels_.attach(geometries_.front()->vertices());
  triangle_texels_.attach(geometries_.front()->triangles());
  instance_texels_.attach(instances_);
  material_texels_.attach(materials_);
}

// The first of the list becomes the geometry of just the primitives in the pose.
void DeviceScene::use_geometry(const Pose& pose) {
  std::vector<std::shared_ptr<const Primitive>> primitives;
  for (const Instance& instance : pose.instances) primitives.push_back(instance.primitive);
  std::sort(primitives.begin(), primitives.end());
  primitives.erase(std::unique(primitives.begin(), primitives.end()), primitives.end());
  const auto found = std::find_if(geometries_.begin(), geometries_.end(),
                                  [&](const auto& geometry) { return geometry->primitives() == primitives; });
  if (found != geometries_.end())
    geometries_.splice(geometries_.begin(), geometries_, found);
  else
    geometries_.push_front(std::make_unique<DeviceGeometry>(std::move(primitives), buffers_));
  if (geometries_.size() > kKeptScenes) geometries_.pop_back();
}

void DeviceScene::use_textures(const Scene& scene) {
  const auto found =
      std::find_if(textures_.begin(), textures_.end(), [&](const auto& textures) { return textures->fits(scene); });
  if (found != textures_.end())
    textures_.splice(textures_.begin(), textures_, found);
  else
    textures_.push_front(std::make_unique<SceneTextures>(scene));
  if (textures_.size() > kKeptScenes) textures_.pop_back();
}

void DeviceScene::upload_materials(const Scene& scene) {
  const SceneTextures& textures = *textures_.front();
  std::vector<DeviceMaterial> packed;
  packed.reserve(scene.materials.size() + 1);
  for (const Material& material : scene.materials) packed.push_back(pack_material(material, textures));
  packed.push_back(pack_material(Material{}, textures));  // the default material of glTF, last
  constexpr std::size_t kMostMaterials = 65536;           // the G-buffer keeps 16 bits
  if (packed.size() > kMostMaterials) throw std::runtime_error("the scene has more than 65535 materials");
  has_textures_ = has_all_textures_ = has_coverage_ = false;
  has_clear_ = has_clear_walls_ = has_clear_volumes_ = has_blend_ = has_smooth_ = has_mirrors_ = false;
  has_lobes_ = std::any_of(scene.materials.begin(), scene.materials.end(), lightwell::has_lobes);
  for (const DeviceMaterial& material : packed) {
    has_textures_ |= material.base_color_texture.slot != 0;
    has_all_textures_ |=
        (material.metallic_roughness_texture.slot | material.normal_texture.slot | material.emissive_texture.slot) != 0;
    has_coverage_ |= (material.flags & (kDeviceMaterialMask | kDeviceMaterialBlend)) != 0;
    has_blend_ |= (material.flags & kDeviceMaterialBlend) != 0;
    has_smooth_ |= may_be_smooth(material);
    has_mirrors_ |= may_be_smooth(material) && material.metallic > 0.0f;
    has_clear_ |= (material.flags & kDeviceMaterialClear) != 0;
    has_clear_walls_ |= (material.flags & kDeviceMaterialClearWall) != 0;
    has_clear_volumes_ |= (material.flags & (kDeviceMaterialClear | kDeviceMaterialClearWall)) == kDeviceMaterialClear;
  }
  materials_.reserve(packed.size() * sizeof(DeviceMaterial));
  materials_.upload(std::span<const DeviceMaterial>(packed));
}

// Deformed ones stand behind all that is rigid.
std::vector<DeformTask> DeviceScene::place_instances(const Pose& pose) {
  DeviceGeometry& geometry = *geometries_.front();
  std::vector<DeformTask> tasks;
  std::uint32_t next_vertex = geometry.rigid_vertices(), next_triangle = geometry.rigid_triangles();
  first_vertices_.clear();
  first_triangles_.clear();
  for (const Instance& instance : pose.instances) {
    const std::size_t primitive = geometry.number_of(instance.primitive);
    first_vertices_.push_back(instance.deformed ? next_vertex : geometry.first_vertex(primitive));
    first_triangles_.push_back(instance.deformed ? next_triangle : geometry.first_index(primitive) / 3);
    if (!instance.deformed) continue;
    tasks.push_back({instance.deformed, primitive, next_vertex, next_triangle});
    next_vertex += static_cast<std::uint32_t>(instance.primitive->positions.size());
    next_triangle += static_cast<std::uint32_t>(instance.primitive->indices.size() / 3);
  }
  if (!tasks.empty())
    geometry.reserve_deformed(next_vertex - geometry.rigid_vertices(), next_triangle - geometry.rigid_triangles());
  return tasks;
}

void DeviceScene::deform(const std::vector<DeformTask>& tasks) {
  if (!deformer_) deformer_.emplace(shaders_);
  position_texels_.bind(UNIT_POSITIONS);
  vertex_texels_.bind(UNIT_VERTICES);
  triangle_texels_.bind(UNIT_TRIANGLES);
  deformer_->run(tasks, *geometries_.front());
}

void DeviceScene::upload_instances(const Scene& scene, const Pose& pose) {
  const DeviceGeometry& geometry = *geometries_.front();
  struct DrawCommand {
    std::uint32_t count, instance_count, first_index;
    std::int32_t base_vertex;
    std::uint32_t base_instance;
  };
  std::vector<DrawCommand> commands[3];
  std::vector<DeviceInstance> packed;
  packed.reserve(pose.instances.size());
  triangles_ = 0;
  for (const Instance& instance : pose.instances) {
    const std::size_t number = packed.size();
    const std::uint32_t material = instance.material >= 0 ? static_cast<std::uint32_t>(instance.material)
                                                          : static_cast<std::uint32_t>(scene.materials.size());
    const auto count = static_cast<std::uint32_t>(instance.primitive->indices.size());
    packed.push_back(
        pack_instance(instance.world_from_object, first_vertices_[number], first_triangles_[number], material));
    const bool double_sided = instance.material >= 0 && scene.materials[material].double_sided;
    const bool mirrored = (packed.back().flags & kDeviceInstanceMirrored) != 0;
    const DrawGroup group = double_sided ? DrawGroup::kDoubleSided
                            : mirrored   ? DrawGroup::kCulledMirrored
                                         : DrawGroup::kCulled;
    commands[static_cast<std::size_t>(group)].push_back(
        {count, 1, geometry.first_index(geometry.number_of(instance.primitive)),
         static_cast<std::int32_t>(first_vertices_[number]), static_cast<std::uint32_t>(number)});
    triangles_ += count / 3;
    has_textures_ = has_textures_ || !instance.primitive->colors.empty();
  }
  instances_.reserve(packed.size() * sizeof(DeviceInstance));
  instances_.upload(std::span<const DeviceInstance>(packed));

  std::vector<DrawCommand> all;
  for (std::size_t group = 0; group < 3; ++group) {
    draws_[group] = {all.size() * sizeof(DrawCommand), static_cast<int>(commands[group].size())};
    all.insert(all.end(), commands[group].begin(), commands[group].end());
  }
  draw_commands_.reserve(all.size() * sizeof(DrawCommand));
  draw_commands_.upload(std::span<const DrawCommand>(all));
}

void DeviceScene::set_vertex_array() {
  const DeviceGeometry& geometry = *geometries_.front();
  const GLuint array = vertex_array_;
  glVertexArrayVertexBuffer(array, 0, geometry.positions().id(), 0, sizeof(glm::vec3));
  glVertexArrayVertexBuffer(array, 1, geometry.vertices().id(), 0, sizeof(DeviceVertex));
  glVertexArrayVertexBuffer(array, 2, instances_.id(), 0, sizeof(DeviceInstance));
  glVertexArrayBindingDivisor(array, 2, 1);
  glVertexArrayElementBuffer(array, geometry.indices().id());
  const auto enable = [array](GLuint attribute, GLuint binding) {
    glEnableVertexArrayAttrib(array, attribute);
    glVertexArrayAttribBinding(array, attribute, binding);
  };
  glVertexArrayAttribFormat(array, 0, 3, GL_FLOAT, GL_FALSE, 0);
  glVertexArrayAttribIFormat(array, 1, 2, GL_UNSIGNED_INT, offsetof(DeviceVertex, normal));
  glVertexArrayAttribFormat(array, 2, 4, GL_FLOAT, GL_FALSE, offsetof(DeviceVertex, uv0));
  glVertexArrayAttribFormat(array, 3, 4, GL_UNSIGNED_SHORT, GL_TRUE, offsetof(DeviceVertex, color));
  for (GLuint row = 0; row < 3; ++row)
    glVertexArrayAttribFormat(array, 4 + row, 4, GL_FLOAT, GL_FALSE, row * static_cast<GLuint>(sizeof(glm::vec4)));
  glVertexArrayAttribIFormat(array, 7, 4, GL_UNSIGNED_INT, offsetof(DeviceInstance, first_vertex));
  enable(0, 0);
  for (const GLuint attribute : {1u, 2u, 3u}) enable(attribute, 1);
  for (const GLuint attribute : {4u, 5u, 6u, 7u}) enable(attribute, 2);
}

DeviceScene::HostHitData DeviceScene::host_hit_data() const {
  return {reinterpret_cast<const DeviceInstance*>(instances_.host()),
          reinterpret_cast<const DeviceTriangle*>(geometries_.front()->triangles().host()),
          reinterpret_cast<const DeviceMaterial*>(materials_.host())};
}

void DeviceScene::feed_instances_before(const gl::Buffer& instances) const {
  glVertexArrayVertexBuffer(vertex_array_, 3, instances.id(), 0, sizeof(DeviceInstanceBefore));
  glVertexArrayBindingDivisor(vertex_array_, 3, 1);
  for (GLuint row = 0; row < 3; ++row)
    glVertexArrayAttribFormat(vertex_array_, 8 + row, 4, GL_FLOAT, GL_FALSE,
                              row * static_cast<GLuint>(sizeof(glm::vec4)));
  glVertexArrayAttribIFormat(vertex_array_, 11, 1, GL_UNSIGNED_INT, offsetof(DeviceInstanceBefore, first_position));
  for (const GLuint attribute : {8u, 9u, 10u, 11u}) {
    glEnableVertexArrayAttrib(vertex_array_, attribute);
    glVertexArrayAttribBinding(vertex_array_, attribute, 3);
  }
}

void DeviceScene::bind() const {
  textures_.front()->bind();
  position_texels_.bind(UNIT_POSITIONS);
  vertex_texels_.bind(UNIT_VERTICES);
  triangle_texels_.bind(UNIT_TRIANGLES);
  instance_texels_.bind(UNIT_INSTANCES);
  material_texels_.bind(UNIT_MATERIALS);
}

void DeviceScene::draw_group(DrawGroup group) const {
  const Draws& draws = draws_[static_cast<std::size_t>(group)];
  glBindVertexArray(vertex_array_);
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, draw_commands_.id());
  glMultiDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_INT, reinterpret_cast<const void*>(draws.offset_bytes),
                              draws.count, 0);
}

}  // namespace lightwell
