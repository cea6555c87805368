#include "renderer/passes/shadow_maps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "renderer/passes/bindings.glsl"

namespace lightwell {

namespace {

// std140 mirrors of shaders/lights.glsl.
struct DeviceLight {
  glm::vec3 position_ws;
  float inverse_range;
  glm::vec3 direction_ws;
  std::uint32_t kind;
  glm::vec3 intensity;
  float spot_scale;
  float spot_offset;
  float shadow_far_m;
  std::int32_t first_shadow_layer;
  float padding;
  glm::mat4 shadow_clip_from_world;
};
static_assert(sizeof(DeviceLight) == 128);

struct DeviceLightsHeader {
  std::uint32_t light_count;
  float shadow_least_variance;
  float shadow_cube_scale;
  std::uint32_t padding;
};

// Where a placed light's view begins, of where it ends.
constexpr float kNearShare = 1e-4f;

int layers_of(LightKind kind) {
  return kind == LightKind::kPoint ? 6 : 1;
}

glm::vec3 any_perpendicular(glm::vec3 unit) {
  const glm::vec3 axis = std::abs(unit.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
  return glm::normalize(glm::cross(unit, axis));
}

// World to light space: x, y across, z along the light's direction (so that depth grows away from the light).
glm::mat4 light_from_world(glm::vec3 position, glm::vec3 direction) {
  const glm::vec3 x = any_perpendicular(direction), y = glm::cross(direction, x);
  const glm::mat3 rotation = glm::transpose(glm::mat3(x, y, direction));
  glm::mat4 matrix(rotation);
  matrix[3] = glm::vec4(-(rotation * position), 1.0f);
  return matrix;
}

// A box around the scene, seen along the light. Depth 0 to 1 through the box.
LightView directional_view(const Pose& pose, glm::vec3 direction) {
  const glm::mat4 turned = light_from_world(glm::vec3(0.0f), direction);
  glm::vec3 low(1e30f), high(-1e30f);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec3 p((corner & 1) != 0 ? pose.bounds_max.x : pose.bounds_min.x,
                      (corner & 2) != 0 ? pose.bounds_max.y : pose.bounds_min.y,
                      (corner & 4) != 0 ? pose.bounds_max.z : pose.bounds_min.z);
    const glm::vec3 q(turned * glm::vec4(p, 1.0f));
    low = glm::min(low, q);
    high = glm::max(high, q);
  }
  const glm::vec3 size = glm::max(high - low, glm::vec3(1e-3f));
  low -= 0.01f * size;
  high += 0.01f * size;
  const glm::vec3 scale(2.0f / (high.x - low.x), 2.0f / (high.y - low.y), 1.0f / (high.z - low.z));
  glm::mat4 clip(1.0f);
  clip[0][0] = scale.x;
  clip[1][1] = scale.y;
  clip[2][2] = scale.z;
  clip[3] = glm::vec4(-(low.x + high.x) / (high.x - low.x), -(low.y + high.y) / (high.y - low.y), -low.z * scale.z, 1);
  return {clip * turned, glm::vec4(0.0f), glm::vec4(direction, high.z - low.z)};
}

// A pyramid of the given half angle's tangent; depth grows from 0 at `near`, and is not what is stored.
glm::mat4 perspective_clip(float tangent, float near, float far) {
  glm::mat4 clip(0.0f);
  clip[0][0] = clip[1][1] = 1.0f / tangent;
  clip[2][2] = far / (far - near);
  clip[3][2] = -far * near / (far - near);
  clip[2][3] = 1.0f;
  return clip;
}

// The six faces of a cube about `position`, in the order and with the axes of cube_face() in shaders/lights.glsl.
std::array<glm::mat4, 6> cube_clips(glm::vec3 position, float tangent, float near, float far) {
  const glm::vec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  const glm::vec3 axes[6][3] = {{z, y, x}, {z, y, -x}, {x, z, y}, {x, z, -y}, {x, y, z}, {x, y, -z}};
  std::array<glm::mat4, 6> clips;
  for (std::size_t face = 0; face < 6; ++face) {
    const glm::mat3 rotation = glm::transpose(glm::mat3(axes[face][0], axes[face][1], axes[face][2]));
    glm::mat4 face_from_world(rotation);
    face_from_world[3] = glm::vec4(-(rotation * position), 1.0f);
    clips[face] = perspective_clip(tangent, near, far) * face_from_world;
  }
  return clips;
}

float farthest_corner_m(const Pose& pose, glm::vec3 from) {
  const glm::vec3 reach = glm::max(glm::abs(pose.bounds_min - from), glm::abs(pose.bounds_max - from));
  return std::max(glm::length(reach) * 1.01f, 1e-3f);
}

DeviceLight pack_light(const PlacedLight& placed) {
  const Light& light = placed.light;
  DeviceLight packed{};
  packed.position_ws = placed.position_ws;
  packed.inverse_range = light.range_m > 0.0f ? 1.0f / light.range_m : 0.0f;
  packed.direction_ws = placed.direction_ws;
  packed.kind = light.kind == LightKind::kDirectional ? 0u : light.kind == LightKind::kPoint ? 1u : 2u;
  packed.intensity = light.color * light.intensity;
  // KHR_lights_punctual, "Inner and outer cone angles".
  const float cos_inner = std::cos(light.inner_cone_angle), cos_outer = std::cos(light.outer_cone_angle);
  packed.spot_scale = 1.0f / std::max(0.001f, cos_inner - cos_outer);
  packed.spot_offset = -cos_outer * packed.spot_scale;
  packed.first_shadow_layer = -1;
  return packed;
}

}  // namespace

void ShadowMaps::bind() const {
  moments.bind(UNIT_SHADOW_MOMENTS);
  if (tints) tints->bind(UNIT_SHADOW_TINT);
  lights.bind_uniform(BINDING_LIGHTS);
}

ShadowMapsPass::ShadowMapsPass(gl::ShaderLibrary& shaders)
    : plain_(shaders.raster("passes/shadow_map.vert", "passes/shadow_map.frag")),
      covered_(shaders.raster("passes/shadow_map.vert", "passes/shadow_map.frag", {"HAS_TEXTURES 1"})),
      tinted_(
          shaders.raster("passes/shadow_map.vert", "passes/shadow_map.frag", {"HAS_TEXTURES 1", "TINTED_SHADOWS 1"})),
      from_depths_(shaders.raster("passes/full_screen.vert", "passes/shadow_map.frag", {"FROM_DEPTHS 1"})),
      from_depths_side_(from_depths_, "side_px"),
      tints_pass_(shaders),
      filter_program_(shaders.raster("passes/full_screen.vert", "passes/shadow_filter.frag")),
      filter_direction_(filter_program_, "direction"),
      filter_radius_(filter_program_, "radius"),
      filter_texel_size_(filter_program_, "texel_size") {
  maps_.lights = gl::Buffer("lights", sizeof(DeviceLightsHeader) + MAX_LIGHTS * sizeof(DeviceLight));
}

int ShadowMapsPass::layers_for(const Pose& pose) {
  int layers = 0;
  for (const PlacedLight& light : pose.lights)
    if (layers + layers_of(light.light.kind) <= MAX_SHADOW_LAYERS) layers += layers_of(light.light.kind);
  return layers;
}

void ShadowMapsPass::resize(int size_px, int filter_px, int layers) {
  const bool same = raw_ && raw_.size_px().x == size_px && maps_.moments.layers() == std::max(layers, 1) &&
                    (filter_px > 1) == (filter_px_ > 1);
  filter_px_ = filter_px;
  if (same) return;
  gl::TextureOptions options;
  options.min_filter = options.mag_filter = GL_LINEAR;
  const glm::ivec2 side(size_px), half(filter_px > 1 ? size_px / 2 : size_px);
  raw_ = gl::Texture("shadow moments of a light", GL_RG32F, side, options);
  depth_ = gl::Texture("shadow depth", GL_DEPTH_COMPONENT32F, side);
  raw_framebuffer_ = gl::Framebuffer("shadow map of a light", {&raw_}, &depth_);
  for (std::size_t i = 0; i < 2; ++i) {
    half_[i] = gl::Texture("shadow moments, half filtered", GL_RG32F, half, options);
    half_framebuffers_[i] = gl::Framebuffer("half filtered shadow map", {&half_[i]}, nullptr);
  }
  options.target = GL_TEXTURE_2D_ARRAY;
  options.layers = std::max(layers, 1);
  maps_.moments = gl::Texture("shadow moments", GL_RG32F, half, options);
  layers_.clear();
  for (int layer = 0; layer < options.layers; ++layer)
    layers_.emplace_back("shadow map", std::initializer_list<const gl::Texture*>{&maps_.moments}, nullptr, layer);
}

// A margin over 90 degrees lets the filter look past the edges of a cube's face.
float ShadowMapsPass::cube_tangent() const {
  return 1.0f + 2.0f * static_cast<float>(filter_px_) / static_cast<float>(depth_.size_px().x);
}

// Fills the light buffer and gives the view of each layer.
std::vector<LightView> ShadowMapsPass::place_lights(const Pose& pose) {
  std::vector<LightView> views;
  std::vector<DeviceLight> lights;
  for (const PlacedLight& placed : pose.lights) {
    if (lights.size() == MAX_LIGHTS) break;
    DeviceLight light = pack_light(placed);
    const int layers = layers_of(placed.light.kind);
    if (static_cast<int>(views.size()) + layers <= MAX_SHADOW_LAYERS) {
      light.first_shadow_layer = static_cast<std::int32_t>(views.size());
      const glm::vec3 at = placed.position_ws;
      light.shadow_far_m = farthest_corner_m(pose, at);
      const glm::vec4 position_far(at, light.shadow_far_m), range(0.0f, 0.0f, 0.0f, light.shadow_far_m);
      const float near = light.shadow_far_m * kNearShare;
      if (placed.light.kind == LightKind::kDirectional) {
        views.push_back(directional_view(pose, placed.direction_ws));
      } else if (placed.light.kind == LightKind::kSpot) {
        const float tangent = std::tan(std::min(placed.light.outer_cone_angle, 1.5f)) * 1.02f;
        views.push_back(
            {perspective_clip(tangent, near, light.shadow_far_m) * light_from_world(at, placed.direction_ws),
             position_far, range});
      } else {
        for (const glm::mat4& face : cube_clips(at, cube_tangent(), near, light.shadow_far_m))
          views.push_back({face, position_far, range});
      }
      light.shadow_clip_from_world = views[static_cast<std::size_t>(light.first_shadow_layer)].clip_from_world;
    }
    lights.push_back(light);
  }
  DeviceLightsHeader header{};
  header.light_count = static_cast<std::uint32_t>(lights.size());
  header.shadow_least_variance = 1e-7f;
  header.shadow_cube_scale = 1.0f / cube_tangent();
  maps_.lights.upload(std::span<const DeviceLightsHeader>(&header, 1));
  maps_.lights.upload(std::span<const DeviceLight>(lights), sizeof header);
  return views;
}

void ShadowMapsPass::draw(const DeviceScene& scene, const LightView& view) {
  raw_framebuffer_.bind();
  const GLfloat far[4] = {1, 1, 0, 0};
  glClearNamedFramebufferfv(raw_framebuffer_.id(), GL_COLOR, 0, far);
  glClearNamedFramebufferfv(raw_framebuffer_.id(), GL_DEPTH, 0, far);
  const Variant& variant = scene.has_clear() ? tinted_ : scene.has_coverage() ? covered_ : plain_;
  variant.program->use();
  variant.clip_from_world = view.clip_from_world;
  variant.position_far = view.position_far;
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  scene.draw([](DrawGroup) {});
  glDisable(GL_DEPTH_TEST);
}

void ShadowMapsPass::draw_by_processor(ViewRasterizer& rasterizer, const LightView& view) {
  const int side = raw_.size_px().x;
  const auto texels = static_cast<std::uint64_t>(side) * static_cast<std::uint64_t>(side);
  if (depths_.reserve(texels * sizeof(ViewDepth))) depth_texels_.attach(depths_);
  const float far_m = view.position_far.w;
  const bool placed = far_m > 0.0f;
  ViewRays rays = light_rays(view.clip_from_world, placed, glm::vec3(view.position_far), side);
  if (placed) rays.t_min = kNearShare;
  rasterizer.depths(rays, placed ? DepthMeasure::kDistance : DepthMeasure::kAlongView, placed ? 1.0f / far_m : 1.0f,
                    depths_);
  raw_framebuffer_.bind();
  depth_texels_.bind(UNIT_VIEW_DEPTHS);
  from_depths_side_ = side;
  from_depths_->use();
  full_screen_.draw_full_screen();
}

void ShadowMapsPass::filter_pass(const gl::Texture& from, const gl::Framebuffer& to, glm::ivec2 direction, int radius) {
  from.bind(0);
  to.bind();
  filter_direction_ = direction;
  filter_radius_ = radius;
  filter_texel_size_ = 1.0f / glm::vec2(maps_.moments.size_px());
  filter_program_->use();
  full_screen_.draw_full_screen();
}

// In the map of half the side.
int ShadowMapsPass::filter_radius() const {
  return filter_px_ <= 3 ? 0 : (filter_px_ + 1) / 4;
}

void ShadowMapsPass::filter_into(int layer) {
  const gl::Framebuffer& target = layers_[static_cast<std::size_t>(layer)];
  const int radius = filter_radius();
  if (radius == 0) return filter_pass(raw_, target, {0, 0}, 0);
  filter_pass(raw_, half_framebuffers_[0], {0, 0}, 0);
  filter_pass(half_[0], half_framebuffers_[1], {1, 0}, radius);
  filter_pass(half_[1], target, {0, 1}, radius);
}

const ShadowMaps& ShadowMapsPass::run(const DeviceScene& scene, const Pose& pose, const ViewChoice& choice) {
  const std::vector<LightView> views = place_lights(pose);
  const bool tinted = scene.has_tinted_shadows();
  if (tinted) tints_pass_.resize(raw_.size_px(), maps_.moments.size_px(), maps_.moments.layers(), filter_radius());
  maps_.tints = tinted ? &tints_pass_.tints() : nullptr;
  ViewRasterizer* rasterizer = choice.for_view(scene, raw_.size_px());
  for (std::size_t layer = 0; layer < views.size(); ++layer) {
    if (rasterizer)
      draw_by_processor(*rasterizer, views[layer]);
    else
      draw(scene, views[layer]);
    filter_into(static_cast<int>(layer));
    if (tinted) tints_pass_.run(scene, raw_, views[layer], static_cast<int>(layer));
  }
  return maps_;
}

}  // namespace lightwell
