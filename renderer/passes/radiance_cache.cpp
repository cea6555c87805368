#include "renderer/passes/radiance_cache.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "renderer/passes/bindings.glsl"

namespace lightwell {

namespace {

constexpr std::uint32_t kCells = 1u << 17;         // four a bucket
constexpr float kCellAngle = 1.0f / 48.0f;         // a cell's side over its distance from the eye
constexpr float kFinestOfScene = 1.0f / 65536.0f;  // the finest cell's side over the scene's diagonal
constexpr float kLeastOfScene = 1.0f / 128.0f;     // the least usual side over the scene's diagonal
constexpr float kLeastUsual_m = 0.08f;             // and in large scenes
constexpr float kMostSamples = 256.0f;
constexpr float kForgettingInMotion = 0.09f, kMostForgetting = 3.0f;  // halvings a frame
// Of all halvings over a time and its double, whatever the time: what a young cache holds is too dark, since every
// bounce builds on what was known of the one before.
constexpr float kForgettingOfAge = 40.0f;
constexpr float kKeptAfterChange = 0.02f;  // samples, after half of the light has changed
constexpr std::uint32_t kPatience = 96;    // frames that a cell is kept without samples
constexpr std::uint32_t kForgetParts = 32;
constexpr std::uint32_t kLongAgo = 0xffffu;

}  // namespace

RadianceCacheUniforms::RadianceCacheUniforms(const gl::ProgramPtr& program)
    : finest_cell_m_(program, "finest_cell_m"),
      least_usual_m_(program, "least_usual_m"),
      cell_angle_(program, "cell_angle"),
      forgetting_(program, "forgetting"),
      kept_after_change_(program, "kept_after_change"),
      buckets_(program, "cell_buckets"),
      frame_(program, "cache_frame"),
      frames_since_change_(program, "frames_since_change") {}

RadianceCache::RadianceCache(gl::ShaderLibrary& shaders)
    : deposit_program_(shaders.compute("passes/cell_deposit.comp")),
      resolve_program_(shaders.compute("passes/cell_resolve.comp")),
      forget_program_(shaders.compute("passes/cell_forget.comp")),
      resolve_cache_(resolve_program_),
      forget_cache_(forget_program_),
      deposit_paths_(deposit_program_, "path_count"),
      forget_first_(forget_program_, "first_cell"),
      forget_count_(forget_program_, "cell_count"),
      patience_(forget_program_, "patience"),
      greatest_light_(deposit_program_, "greatest_light"),
      most_samples_(resolve_program_, "most_samples"),
      keys_("cell keys", kCells * sizeof(std::uint32_t)),
      values_("cell values", kCells * sizeof(glm::uvec4)),
      sums_("cell sums", kCells * 8 * sizeof(std::uint32_t)),
      touched_("cells touched", (kCells + 4) * sizeof(std::uint32_t)),
      key_texels_("cell keys", GL_RGBA32UI),
      value_texels_("cell values", GL_RGBA32UI) {
  key_texels_.attach(keys_);
  value_texels_.attach(values_);
  clear();
}

void RadianceCache::clear() {
  for (gl::Buffer* buffer : {&keys_, &values_, &sums_, &touched_}) buffer->clear();
  frame_number_ = changed_frame_ = 0;
}

void RadianceCache::set(const RadianceCacheUniforms& uniforms) const {
  uniforms.finest_cell_m_ = finest_cell_m_;
  uniforms.least_usual_m_ = least_usual_m_;
  uniforms.cell_angle_ = kCellAngle;
  uniforms.forgetting_ = forgetting_;
  uniforms.kept_after_change_ = kept_after_change_;
  uniforms.buckets_ = kCells / 4;
  uniforms.frame_ = frame_number_;
  uniforms.frames_since_change_ = changed_frame_ > 0 ? frame_number_ - changed_frame_ : kLongAgo;
}

void RadianceCache::begin_frame(const Pose& pose, const SceneChange& change) {
  ++frame_number_;
  if (change.light_share > 0.0f) {
    changed_frame_ = frame_number_;
    kept_after_change_ = kKeptAfterChange * left_over_gone(change.light_share);
  }
  const float of_age = kForgettingOfAge / static_cast<float>(frame_number_ - changed_frame_ + 1);
  forgetting_ = std::clamp(of_age, change.moving ? kForgettingInMotion : 0.0f, kMostForgetting);
  // A power of two, so that cells stay where they are while the scene's bounds change a little.
  const float diagonal_m = std::max(glm::distance(pose.bounds_min, pose.bounds_max), 1e-6f);
  finest_cell_m_ = std::exp2(std::ceil(std::log2(diagonal_m))) * kFinestOfScene;
  least_usual_m_ = std::min(diagonal_m * kLeastOfScene, kLeastUsual_m);
  keys_.bind_storage(BINDING_CELL_KEYS);
  values_.bind_storage(BINDING_CELL_VALUES);
  set(forget_cache_);
  forget_first_ = frame_number_ % kForgetParts * (kCells / kForgetParts);
  forget_count_ = kCells / kForgetParts;
  patience_ = kPatience;
  forget_program_->dispatch(kCells / kForgetParts);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
}

void RadianceCache::bind_for_lookups(const RadianceCacheUniforms& uniforms) const {
  key_texels_.bind(UNIT_CELL_KEYS);
  value_texels_.bind(UNIT_CELL_VALUES);
  keys_.bind_storage(BINDING_CELL_KEYS);
  set(uniforms);
}

void RadianceCache::deposit(std::uint32_t paths, const gl::BufferTexture& next_states, const gl::Buffer& light,
                            const gl::BufferTexture& visible, float greatest_light) {
  const std::array<std::uint32_t, 4> nothing_touched{0, 1, 1, 0};
  touched_.upload(std::span<const std::uint32_t>(nothing_touched));
  next_states.bind(UNIT_NEXT_STATES);
  visible.bind(UNIT_SAMPLE_VISIBLE);
  light.bind_storage(BINDING_SAMPLE_LIGHT);
  sums_.bind_storage(BINDING_CELL_SUMS);
  touched_.bind_storage(BINDING_CELLS_TOUCHED);
  deposit_paths_ = paths;
  greatest_light_ = greatest_light;
  deposit_program_->dispatch(paths);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);

  values_.bind_storage(BINDING_CELL_VALUES);
  set(resolve_cache_);
  most_samples_ = kMostSamples;
  resolve_program_->dispatch_indirect(touched_);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
}

std::uint64_t RadianceCache::memory_bytes() const {
  std::uint64_t bytes = 0;
  for (const gl::Buffer* buffer : {&keys_, &values_, &sums_, &touched_}) bytes += buffer->size_bytes();
  return bytes;
}

}  // namespace lightwell
