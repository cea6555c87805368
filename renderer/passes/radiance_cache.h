// Light that arrives at surfaces after it has bounced, kept in cells of the world over the frames: a hash grid whose
// cells are a cube of space and a range of normals, finer near the eye. It carries all bounces but the first.
#pragma once

#include "renderer/gl/buffer.h"
#include "renderer/gl/program.h"
#include "renderer/gl/texture.h"
#include "renderer/passes/scene_changes.h"

namespace lightwell {

/// The uniforms of shaders/cell_value.glsl and shaders/radiance_cache.glsl in one program.
class RadianceCacheUniforms {
 public:
  explicit RadianceCacheUniforms(const gl::ProgramPtr& program);

 private:
  friend class RadianceCache;
  gl::Uniform<float> finest_cell_m_, least_usual_m_, cell_angle_, forgetting_, kept_after_change_;
  gl::Uniform<std::uint32_t> buckets_, frame_, frames_since_change_;
};

class RadianceCache {
 public:
  explicit RadianceCache(gl::ShaderLibrary& shaders);

  /// Forgets everything.
  void clear();

  /// Begins a frame, before anything looks into the cache. What cells know counts for less with time while things move
  /// and while the cache is young, for then it holds too little light; for hardly anything when the light has changed.
  void begin_frame(const Pose& pose, const SceneChange& change);

  /// Binds what shaders/radiance_cache.glsl declares.
  void bind_for_lookups(const RadianceCacheUniforms& uniforms) const;

  /// Adds what came along `paths` rays to the cells named in `next_states`; `light` and `visible` as
  /// passes/cell_deposit.comp reads them. Afterwards cells have their new values.
  void deposit(std::uint32_t paths, const gl::BufferTexture& next_states, const gl::Buffer& light,
               const gl::BufferTexture& visible, float greatest_light);

  std::uint64_t memory_bytes() const;

 private:
  void set(const RadianceCacheUniforms& uniforms) const;

  gl::ProgramPtr deposit_program_, resolve_program_, forget_program_;
  RadianceCacheUniforms resolve_cache_, forget_cache_;
  gl::Uniform<std::uint32_t> deposit_paths_, forget_first_, forget_count_, patience_;
  gl::Uniform<float> greatest_light_, most_samples_;
  gl::Buffer keys_, values_, sums_, touched_;
  gl::BufferTexture key_texels_, value_texels_;
  float finest_cell_m_ = 1.0f, least_usual_m_ = 1.0f;
  float forgetting_ = 0.0f;         // halvings a frame
  float kept_after_change_ = 0.0f;  // samples
  std::uint32_t frame_number_ = 0, changed_frame_ = 0;
};

}  // namespace lightwell
