// Everything that lights a pose, in one table to choose from by power: punctual lights, emissive triangles and the
// environment. Any pass may sample it through shaders/light_sampling.glsl.
#pragma once

#include <optional>

#include "renderer/gl/buffer.h"
#include "renderer/gl/program.h"
#include "renderer/gl/texture.h"
#include "renderer/gl/variants.h"
#include "renderer/passes/alias_table.h"
#include "renderer/passes/emitters.h"
#include "renderer/passes/environment_cells.h"

namespace lightwell {

/// The strongest punctual lights, by power, are the first of the table and left out of one of its tables of choices.
inline constexpr std::uint32_t kStrongestLights = 3;

/// Where in the buffers things are; uniforms of the same names in shaders/light_sampling.glsl.
struct LightCounts {
  std::uint32_t lights = 0;        // all that can be chosen
  std::uint32_t punctual = 0;      // the first of them; a table of their own follows the one of all lights
  std::uint32_t others = 0;        // entries of the table of punctual ones but the strongest; 0: there is none
  std::uint32_t others_first = 0;  // where that table begins
  std::uint32_t sized_first = 0;   // where the table of lights with a size begins
  float sized_share = 0.0f;        // of the power of all; 0: there is none
  glm::ivec2 environment_cells{0};
  float environment_probability = 0.0f;
};

/// Whether a sky without a picture is in the table. It is smooth, so that rays which miss find its light well enough,
/// and without it more of the samples go to other lights.
enum class PlainSky { kSampled, kLeftToRays };

class LightTable {
 public:
  explicit LightTable(PlainSky plain_sky = PlainSky::kSampled);

  /// Brings the table to a pose. What did not change since the last call is kept.
  void prepare(const Scene& scene, const Pose& pose);

  /// Binds what shaders/light_sampling.glsl declares.
  void bind() const;

  const LightCounts& counts() const { return counts_; }
  /// Which kinds of light there are: LIGHTS_... of shaders/light_sampling.glsl. Those that have a size alone, or all.
  gl::Defines sized_defines() const;
  gl::Defines defines() const;
  bool has_punctual() const { return counts_.punctual > 0; }
  bool has_emitters() const { return has_emitters_; }
  bool has_sized() const { return counts_.sized_share > 0.0f; }
  /// Of all lights: what leaves them, or of those infinitely far what meets the scene; flux by luminance, lumens over a
  /// constant.
  double power() const { return power_; }
  bool has_environment() const { return counts_.environment_probability > 0.0f; }

 private:
  struct EmitterKey {  // what an instance's emitters depend on
    const Primitive* primitive;
    std::shared_ptr<const DeformedShape> deformed;
    glm::mat4 world_from_object;
    glm::vec3 radiance;
    TextureUse texture;
    std::shared_ptr<const Image> image;
    std::size_t instance;
    bool operator==(const EmitterKey& other) const;
  };
  struct EmittingInstance {
    EmitterKey key;
    std::shared_ptr<const Primitive> primitive;
    std::vector<Emitter> emitters;
  };
  struct EnvironmentKey {
    glm::vec3 zenith, horizon, ground;
    float strength;
    std::shared_ptr<const ImageHdr> image;
    bool operator==(const EnvironmentKey&) const = default;
  };

  bool update_emitters(const Scene& scene, const Pose& pose);
  bool update_environment(const Environment& environment);
  void upload(const Pose& pose);
  void append_sized_lights(std::vector<double> powers, std::size_t punctual, std::vector<AliasEntry>& choices);
  void append_other_punctual(std::vector<double> powers, std::size_t punctual, std::vector<AliasEntry>& choices);

  PlainSky plain_sky_;
  EmissiveTextures emissive_textures_;
  std::vector<EmittingInstance> emitting_;
  std::optional<EnvironmentKey> environment_key_;
  EnvironmentCells cells_;
  LightCounts counts_;
  double power_ = 0.0;
  bool has_emitters_ = false;
  std::size_t uploaded_instances_ = 0;
  gl::Buffer lights_, choices_, instance_lights_;
  gl::BufferTexture light_texels_, choice_texels_, instance_light_texels_;
};

/// The uniforms of shaders/light_sampling.glsl in one program.
class LightTableUniforms {
 public:
  explicit LightTableUniforms(const gl::ProgramPtr& program);
  void set(const LightCounts& counts) const;

 private:
  gl::Uniform<std::uint32_t> lights_, punctual_, sized_first_;
  gl::Uniform<float> sized_share_;
  gl::Uniform<glm::ivec2> cells_;
  gl::Uniform<float> environment_probability_;
};

}  // namespace lightwell
