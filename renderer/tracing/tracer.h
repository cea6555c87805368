// The seam: a buffer of rays in, a buffer of hit records or visibility bits out. Two tracers implement it, Embree on a
// software device and a compute shader on a GPU; one test holds them against each other.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "renderer/gl/buffer.h"
#include "renderer/gl/texture.h"
#include "renderer/scene/pose.h"

namespace lightwell {

/// std430 layout, 32 bytes; `struct Ray` in shaders/ray.glsl. A ray with t_max < t_min, or that is not finite,
/// is inactive: a miss at no cost.
struct Ray {
  glm::vec3 origin_ws;
  float t_min;
  glm::vec3 direction_ws;  // unit
  float t_max;
};
static_assert(sizeof(Ray) == 32);

/// std430 layout, 20 bytes; `struct Hit` in shaders/ray.glsl.
struct Hit {
  float t;                 // distance in metres; negative: a miss (the ray sees the environment)
  std::uint32_t instance;  // in Pose::instances
  std::uint32_t triangle;  // in Primitive::indices / 3
  float u, v;              // barycentrics of the second and third vertex
};
static_assert(sizeof(Hit) == 20);

constexpr float kMiss = -1.0f;

/// Work groups of this many invocations run over a HitList.
constexpr std::uint32_t kHitGroup = 64;

/// Which rays of a batch hit something, for passes that have nothing to do for misses.
struct HitList {
  /// `buffers` as for the rays.
  explicit HitList(gl::BufferUse buffers);
  /// Room for the hits of `most_rays` rays.
  void resize(std::uint32_t most_rays);

  gl::Buffer rays;                                 // uint32 each: indices of rays, see closest_hit for their order
  gl::BufferTexture texels{"hit list", GL_R32UI};  // the same
  // uint32 x 5: groups of kHitGroup in x, 1, 1 (an indirect dispatch's arguments); the count of hits; how many rays
  // test_candidates has traced anew
  gl::Buffer dispatch;

  /// Rays that test_candidates has traced anew for this list since it was made or they were forgotten, modulo 2^32.
  /// Waits for the device.
  std::uint32_t traced_anew() const;
  void forget_traced();
};

/// Where the rays of a pixel start, and which patch gives it directions and candidates; std430 layout, 32 bytes.
struct PixelOrigin {
  glm::vec3 above_ws;         // origin of rays to the surface's outer side
  std::uint32_t patch_index;  // kNoPatch: it has no rays
  glm::vec3 down_ws;          // from there to the origin of rays to the inner side: those with a positive cosine to it
  std::uint32_t is_patch;     // 1 if the rays of the patch are the pixel's own
};
static_assert(sizeof(PixelOrigin) == 32);
constexpr std::uint32_t kNoPatch = ~0u;

/// Scaling up (thesis 5.2): what patches hit is tried again for each of their pixels, with its own origin. Buffers are
/// of the kind that the tracer reads.
struct CandidateTest {
  const gl::Buffer& pixels;      // PixelOrigin
  const gl::Buffer& directions;  // vec4 (unit in xyz): direction * patches + patch
  const gl::Buffer&
      candidates;  // Hit: (group * directions + direction) * patches + patch; triangles as the group counts
  std::uint32_t pixel_count, patch_count, direction_count;
  std::uint32_t group_count;  // triangle t of group g is triangle t * group_count + g of its primitive
  bool trace_missed;          // a pixel for which no candidate remains of those its patch had traces the ray itself
};

/// Which triangles count: alpha from the base-colour texture, tested alike by both tracers.
/// Texel is nearest, wrap as the sampler says; alpha = texel.a * factor (vertex colours are not looked at).
/// kMask hits where alpha >= cutoff. kBlend hits where alpha > coverage_threshold(instance, triangle, u, v).
struct Coverage {
  AlphaMode mode = AlphaMode::kOpaque;
  float cutoff = 0.5f;
  float factor = 1.0f;
  std::shared_ptr<const Image> image;  // null: alpha is `factor` alone
  TextureUse use;
  Wrap wrap_s = Wrap::kRepeat, wrap_t = Wrap::kRepeat;
  bool double_sided = false;  // a camera sees its back as well; rays meet both sides of everything
};

/// Where the device has the instances' vertices.
struct DevicePositions {
  const gl::Buffer* buffer = nullptr;    // vec3, tightly packed; null: it has none
  std::span<const std::uint32_t> first;  // of each instance
};

/// What a tracer needs to know of the world in one frame.
struct TraceScene {
  std::span<const Instance> instances;
  std::span<const Coverage> coverage;  // one per instance
  DevicePositions device_positions{};  // a tracer on the device fits its hierarchies to those of deformed instances
};

class HostTracer;

class Tracer {
 public:
  virtual ~Tracer() = default;

  /// Null for a tracer on the device.
  virtual HostTracer* host() { return nullptr; }

  /// "embree", "compute" or "brute-force".
  virtual std::string_view name() const = 0;

  /// Takes the instances of this frame: hierarchies of new geometry are built and kept, deformed geometry is refitted
  /// (rebuilt when the refit has degraded), unused geometry is dropped after a while, the top level is built anew.
  /// Geometry is identified by Instance::primitive's address, deformed geometry by (node, primitive_index) as well.
  virtual void update(const TraceScene& scene) = 0;

  /// For rays[0, count): the nearest hit with t_min < t < t_max, or t = kMiss. Both sides of a triangle are hit.
  /// Buffers hold Ray and Hit elements. `list`, where not null, is filled with the rays that hit; where a ray's result
  /// may depend on its neighbours in the buffer (Embree's packets round otherwise than single rays) they are in order,
  /// so that who makes new rays of them gets the same every time. The call orders itself against GL commands before and
  /// after it.
  virtual void closest_hit(const gl::Buffer& rays, std::uint32_t count, gl::Buffer& hits, HitList* list = nullptr) = 0;

  /// For rays[0, count): bit (i % 32) of word (i / 32) of `visible` is 1 where nothing lies between t_min and t_max.
  virtual void any_hit(const gl::Buffer& rays, std::uint32_t count, gl::Buffer& visible) = 0;

  /// For each pixel and direction the nearest of its patch's candidates that its own ray meets: hits[direction *
  /// pixels + pixel], t = kMiss where there is none. `list` is filled with them, as by closest_hit.
  virtual void test_candidates(const CandidateTest& test, gl::Buffer& hits, HitList& list) = 0;

  /// Bytes held for hierarchies, on whichever side they live.
  virtual std::uint64_t memory_bytes() const = 0;
};

/// The tracer that never leaves the device.
std::unique_ptr<Tracer> make_compute_tracer();

/// The same without a hierarchy: every ray tries every triangle, as in the thesis' own implementation. What it costs is
/// linear in both.
std::unique_ptr<Tracer> make_brute_force_tracer();

/// One of the two that counts as well: to the first word of `tests` it adds, modulo 2^32, how many triangles rays were
/// tested against. Slower; `tests` must outlive it.
std::unique_ptr<Tracer> make_counting_tracer(bool brute_force, const gl::Buffer& tests);

}  // namespace lightwell
