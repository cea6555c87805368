// The scene on the device in one frame: geometry, instances, materials, textures; draws for the raster passes.
#pragma once

#include <list>
#include <memory>
#include <optional>
#include <vector>

#include "renderer/gl/buffer.h"
#include "renderer/gl/variants.h"
#include "renderer/passes/deformer.h"
#include "renderer/passes/device_geometry.h"
#include "renderer/passes/scene_textures.h"
#include "renderer/scene/pose.h"
#include "renderer/tracing/tracer.h"

namespace lightwell {

struct DeviceInstance;
struct DeviceMaterial;
struct DeviceTriangle;

/// Which triangles a draw takes, by the state it needs.
enum class DrawGroup { kCulled, kCulledMirrored, kDoubleSided };

/// What of the scene lives on the device. `prepare` brings it to a pose; the rest reads it.
class DeviceScene {
 public:
  /// `buffers`: host-visible where code on the processor asks for host_hit_data().
  explicit DeviceScene(gl::ShaderLibrary& shaders, gl::BufferUse buffers = gl::BufferUse::kDevice);
  ~DeviceScene();

  /// Uploads what changed since the last frame; scenes used lately are kept, so that sessions can alternate.
  /// Throws std::runtime_error when the scene is over the device's limits.
  /// `multiple_scattering` is the setting of that name.
  void prepare(const Scene& scene, const Pose& pose, bool multiple_scattering);

  /// Binds everything that shaders/scene_data.glsl and textures.glsl declare.
  void bind() const;

  /// What the shaders of this scene must be able to do, as defines. Textures: HAS_TEXTURES for base colours and vertex
  /// colours, ALL_TEXTURES as well for anything else, and the sizes in use. Lights: see shaders/lights.glsl.
  const gl::Defines& texture_defines() const { return texture_defines_; }
  const gl::Defines& light_defines() const { return light_defines_; }
  /// MULTISCATTER, and HAS_LOBES where a material has clearcoat, sheen, transmission or a specular colour.
  const gl::Defines& brdf_defines() const { return brdf_defines_; }
  const gl::Defines& lobe_defines() const { return lobe_defines_; }  // HAS_LOBES alone
  bool has_lobes() const { return has_lobes_; }
  /// No instance has a specular lobe or one of an extension: a path tracer's shaders may leave them out (LAMBERT_ONLY).
  bool is_lambert() const { return is_lambert_; }
  const gl::Defines& environment_defines() const { return environment_defines_; }
  /// Alpha masks or blends.
  bool has_coverage() const { return has_coverage_; }
  /// Surfaces that light goes straight on through; the same without a volume behind them.
  /// SMOOTH_SURFACES, where there are some: see shaders/smooth_lobe.glsl.
  const gl::Defines& smooth_defines() const { return smooth_defines_; }
  bool has_smooth() const { return has_smooth_; }
  bool has_mirrors() const { return has_mirrors_; }  // smooth metals
  bool has_clear() const { return has_clear_; }
  bool has_clear_walls() const { return has_clear_walls_; }
  bool has_clear_volumes() const { return has_clear_volumes_; }  // those that have one
  /// Clear surfaces or alpha blends: shadows with a colour (TINTED_SHADOWS).
  bool has_tinted_shadows() const { return has_clear_ || has_blend_; }
  std::uint64_t triangles() const { return triangles_; }

  /// What shaders/hit_surface.glsl reads, once the device has nothing left to do for it.
  struct HostHitData {
    const DeviceInstance* instances;
    const DeviceTriangle* triangles;
    const DeviceMaterial* materials;
  };
  HostHitData host_hit_data() const;
  /// Valid until the next frame is prepared.
  DevicePositions positions() const { return {&geometries_.front()->positions(), first_vertices_}; }
  const Environment& environment() const { return environment_; }

  /// What the motion variant of g_buffer.vert is fed with as well: a DeviceInstanceBefore for each instance.
  void feed_instances_before(const gl::Buffer& instances) const;

  /// Draws all instances in three groups; `begin_group` sets the state of each before it is drawn.
  template <class BeginGroup>
  void draw(const BeginGroup& begin_group) const {
    for (const DrawGroup group : {DrawGroup::kCulled, DrawGroup::kCulledMirrored, DrawGroup::kDoubleSided}) {
      if (draws_[static_cast<std::size_t>(group)].count == 0) continue;
      begin_group(group);
      draw_group(group);
    }
  }

 private:
  struct Draws {
    std::uint64_t offset_bytes = 0;
    int count = 0;
  };
  void use_geometry(const Pose& pose);
  void use_textures(const Scene& scene);
  std::vector<DeformTask> place_instances(const Pose& pose);
  void upload_instances(const Scene& scene, const Pose& pose);
  void deform(const std::vector<DeformTask>& tasks);
  void upload_materials(const Scene& scene);
  void set_defines(const Scene& scene, const Pose& pose, bool multiple_scattering);
  void attach_buffers();
  void set_vertex_array();
  void draw_group(DrawGroup group) const;

  std::list<std::unique_ptr<DeviceGeometry>> geometries_;  // most recently used first
  std::list<std::unique_ptr<SceneTextures>> textures_;
  gl::Buffer instances_, materials_, draw_commands_;
  gl::BufferTexture position_texels_, vertex_texels_, triangle_texels_, instance_texels_, material_texels_;
  GLuint vertex_array_ = 0;
  Draws draws_[3];
  bool has_textures_ = false, has_all_textures_ = false, has_coverage_ = false, has_lobes_ = false, is_lambert_ = false;
  bool has_clear_ = false, has_clear_walls_ = false, has_clear_volumes_ = false, has_mirrors_ = false,
       has_blend_ = false, has_smooth_ = false;
  std::vector<std::uint32_t> first_vertices_, first_triangles_;  // of each instance
  gl::ShaderLibrary& shaders_;
  std::optional<Deformer> deformer_;  // made for the first scene that deforms
  gl::Defines texture_defines_, light_defines_, brdf_defines_, lobe_defines_, environment_defines_, smooth_defines_;
  std::uint64_t triangles_ = 0;
  gl::BufferUse buffers_;
  Environment environment_;
};

}  // namespace lightwell
