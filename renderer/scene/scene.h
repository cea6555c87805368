// The scene as plain values, shaped as glTF 2.0 shapes it: right-handed, +Y up, metres, radians, photometric light.
// Heavy data (meshes, images) is immutable and shared, so that copying a Scene is cheap: a session edits its own copy.
// All indices refer to the vectors of `Scene`; -1 means none.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace lightwell {

/// Decoded pixels, 8 bits per channel RGBA, row 0 first as in the file (glTF: v = 0 is the first row).
struct Image {
  std::string name;
  glm::ivec2 size_px{0};
  std::vector<std::uint8_t> rgba;  // size_px.x * size_px.y * 4
};

/// Linear floating-point RGB, for environments. Row 0 is the zenith (latitude-longitude, +Y up).
struct ImageHdr {
  std::string name;
  glm::ivec2 size_px{0};
  std::vector<float> rgb;  // size_px.x * size_px.y * 3, finite, not negative
};

enum class Wrap : std::uint8_t { kRepeat, kMirroredRepeat, kClampToEdge };

struct Sampler {
  bool mag_nearest = false;
  bool min_nearest = false;  // the filter within a level
  bool mipmapped = true;
  Wrap wrap_s = Wrap::kRepeat;
  Wrap wrap_t = Wrap::kRepeat;
};

struct Texture {
  std::string name;
  int image = -1;
  Sampler sampler;
};

/// A material's use of a texture, with KHR_texture_transform applied as uv' = offset + rotation * (scale * uv).
struct TextureUse {
  int texture = -1;
  int uv_set = 0;  // 0 or 1
  glm::vec2 offset{0.0f};
  float rotation = 0.0f;  // radians, counter-clockwise as the extension defines it
  glm::vec2 scale{1.0f};
  bool operator==(const TextureUse&) const = default;
};

enum class AlphaMode : std::uint8_t { kOpaque, kMask, kBlend };

/// glTF 2.0 metallic-roughness with the extensions the renderer knows. Colours are linear BT.709.
struct Material {
  std::string name;
  glm::vec4 base_color_factor{1.0f};
  float metallic_factor = 1.0f;
  float roughness_factor = 1.0f;
  glm::vec3 emissive_factor{0.0f};
  float emissive_strength = 1.0f;  // KHR_materials_emissive_strength; emissive * strength is in nit
  float normal_scale = 1.0f;
  float occlusion_strength = 1.0f;
  TextureUse base_color_texture;          // sRGB, alpha is coverage
  TextureUse metallic_roughness_texture;  // G roughness, B metallic
  TextureUse normal_texture;              // tangent space
  TextureUse occlusion_texture;           // R; kept, but global illumination makes its own occlusion
  TextureUse emissive_texture;            // sRGB
  AlphaMode alpha_mode = AlphaMode::kOpaque;
  float alpha_cutoff = 0.5f;
  bool double_sided = false;
  bool unlit = false;  // KHR_materials_unlit: base colour is shown as it is and lights nothing

  float ior = 1.5f;              // KHR_materials_ior; 0: reflects everything
  float specular_factor = 1.0f;  // KHR_materials_specular
  glm::vec3 specular_color_factor{1.0f};
  TextureUse specular_texture;        // A
  TextureUse specular_color_texture;  // sRGB
  float transmission_factor = 0.0f;   // KHR_materials_transmission
  TextureUse transmission_texture;    // R
  float thickness_factor = 0.0f;      // KHR_materials_volume: 0 is thin-walled; how thick, the mesh itself says
  float attenuation_distance = 0.0f;  // metres; 0 means infinite
  glm::vec3 attenuation_color{1.0f};
  float clearcoat_factor = 0.0f;  // KHR_materials_clearcoat
  float clearcoat_roughness = 0.0f;
  float clearcoat_normal_scale = 1.0f;
  TextureUse clearcoat_texture;            // R
  TextureUse clearcoat_roughness_texture;  // G
  TextureUse clearcoat_normal_texture;     // tangent space; without it the mesh's own normal
  glm::vec3 sheen_color_factor{0.0f};      // KHR_materials_sheen
  float sheen_roughness = 0.0f;
  TextureUse sheen_color_texture;      // sRGB
  TextureUse sheen_roughness_texture;  // A
  bool operator==(const Material&) const = default;
};

struct MorphTarget {
  std::vector<glm::vec3> positions;  // displacements; empty or one per vertex
  std::vector<glm::vec3> normals;
  std::vector<glm::vec3> tangents;
  glm::vec3 displacement_min{0.0f}, displacement_max{0.0f};  // of `positions`; fill_bounds() knows them
};

/// The box around the vertices of a primitive that a joint moves, where they are before it does.
struct JointBounds {
  std::uint32_t joint = 0;  // in Skin::joints
  glm::vec3 min{0.0f}, max{0.0f};
};

/// Indexed triangles of one material. Every per-vertex array is empty or has one element per position,
/// save `normals` and `tangents`, which a loader always fills. All values are finite, all indices in range.
struct Primitive {
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;   // unit
  std::vector<glm::vec4> tangents;  // unit xyz, w = handedness: bitangent = w * cross(normal, tangent)
  std::vector<glm::vec2> uv0;
  std::vector<glm::vec2> uv1;
  std::vector<glm::vec4> colors;       // linear, multiplied with the base colour
  std::vector<glm::uvec4> joints;      // indices into Skin::joints
  std::vector<glm::vec4> weights;      // sum to 1
  std::vector<std::uint32_t> indices;  // 3 per triangle
  std::vector<MorphTarget> morph_targets;
  int material = -1;                             // -1: the default material of glTF
  glm::vec3 bounds_min{0.0f}, bounds_max{0.0f};  // of `positions`
  std::vector<JointBounds> joint_bounds;         // of the joints that move any vertex
};

struct Mesh {
  std::string name;
  std::vector<Primitive> primitives;
  std::vector<float> weights;  // default morph weights
};

struct Transform {
  glm::vec3 translation{0.0f};
  glm::quat rotation{1.0f, 0.0f, 0.0f, 0.0f};
  glm::vec3 scale{1.0f};
};

struct Node {
  std::string name;
  int parent = -1;  // always consistent with `children` and `Scene::roots`
  std::vector<int> children;
  Transform local;                  // used when `matrix` is empty
  std::optional<glm::mat4> matrix;  // glTF: a node with a matrix is never animated
  int mesh = -1, camera = -1, light = -1, skin = -1;
  std::vector<float> weights;  // morph weights of this instance; empty: the mesh's
  bool visible = true;
};

enum class LightKind : std::uint8_t { kDirectional, kPoint, kSpot };

/// KHR_lights_punctual: shines along the node's -Z.
struct Light {
  std::string name;
  LightKind kind = LightKind::kPoint;
  glm::vec3 color{1.0f};                    // linear
  float intensity = 1.0f;                   // lux for directional, candela for point and spot
  float range_m = 0.0f;                     // 0: infinite
  float inner_cone_angle = 0.0f;            // radians
  float outer_cone_angle = 0.78539816339f;  // radians, inner < outer <= pi/2
  bool operator==(const Light&) const = default;
};

struct Camera {
  std::string name;
  bool perspective = true;
  float yfov = 0.8f;          // radians
  float aspect_ratio = 0.0f;  // kept for writing; the picture's own size decides. 0: none given
  float znear = 0.05f;
  float zfar = 0.0f;               // 0: infinite
  float xmag = 1.0f, ymag = 1.0f;  // orthographic half sizes
};

struct Skin {
  std::string name;
  std::vector<int> joints;                 // nodes
  std::vector<glm::mat4> joint_from_mesh;  // inverse bind matrices, one per joint
};

enum class Interpolation : std::uint8_t { kStep, kLinear, kCubicSpline };
enum class AnimatedProperty : std::uint8_t { kTranslation, kRotation, kScale, kWeights };

/// A keyframed property of one node. `values` has `width` floats per key (3, 4 or the number of morph targets),
/// three times as many for cubic splines (in-tangent, value, out-tangent). Times ascend.
struct AnimationChannel {
  int node = -1;
  AnimatedProperty property = AnimatedProperty::kTranslation;
  Interpolation interpolation = Interpolation::kLinear;
  std::vector<float> times_s;
  std::vector<float> values;
  int width = 3;
};

/// Keyframes for what glTF's core cannot animate, as KHR_animation_pointer does: light colour and intensity.
struct LightChannel {
  int light = -1;
  enum class Property : std::uint8_t { kColor, kIntensity } property = Property::kIntensity;
  Interpolation interpolation = Interpolation::kLinear;
  std::vector<float> times_s;
  std::vector<float> values;
};

struct Animation {
  std::string name;
  std::vector<AnimationChannel> channels;
  std::vector<LightChannel> light_channels;
  float duration_s = 0.0f;  // the last key of all channels; playback repeats after it
};

/// Light from beyond the scene: what a ray that misses everything sees.
struct Environment {
  glm::vec3 zenith_radiance{0.0f};  // nit; a gradient from horizon to zenith above, `ground` below
  glm::vec3 horizon_radiance{0.0f};
  glm::vec3 ground_radiance{0.0f};
  std::shared_ptr<const ImageHdr> image;  // replaces the gradient when set
  float strength = 1.0f;
  float rotation = 0.0f;  // radians about +Y
};

/// A whole scene. Copying shares meshes and images.
struct Scene {
  std::string name;
  std::vector<std::shared_ptr<const Mesh>> meshes;
  std::vector<std::shared_ptr<const Image>> images;
  std::vector<Texture> textures;
  std::vector<Material> materials;
  std::vector<Node> nodes;
  std::vector<int> roots;
  std::vector<Light> lights;
  std::vector<Camera> cameras;
  std::vector<Skin> skins;
  std::vector<Animation> animations;  // all play together
  Environment environment;
  std::vector<std::string> warnings;  // what the loader could not honour, for the log
};

/// Triangles over all instances (a mesh used by two nodes counts twice).
std::uint64_t count_triangles(const Scene& scene);

}  // namespace lightwell
