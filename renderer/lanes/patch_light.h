// Scaling up on the processor: what pixels of a patch do with the candidates of a direction, in lanes. Plain data and
// plain functions, for they are compiled for several kinds of processor (renderer/lanes/glsl.h).
#pragma once

#include <cstdint>

#include "renderer/tracing/compact_hierarchy.h"
#include "renderer/tracing/wide_hierarchy.h"

namespace lightwell::lanes {

constexpr std::uint32_t kChunkPixels = 64;
constexpr std::uint32_t kMostLanes = 16;
using PixelFloats = float[kChunkPixels + kMostLanes];
using PixelWords = std::uint32_t[kChunkPixels + kMostLanes];

/// Pixels of the indirect map as passes/number_unmatched.comp packs them; the words of a G-buffer's texels.
struct PackedReceivers {
  PixelWords normal, geometric_normal, base_color_rg, base_color_b_metallic;  // RGBA32UI surface
  PixelWords material_roughness, dielectric;                                  // RG32UI material
  PixelWords to_camera;                                                       // octahedral, 2 x snorm16
};

/// The same, ready to gather at; where their rays start; and what the direction at hand meets. World space, metres.
struct alignas(64) PatchPixels {
  PixelFloats above[3], down[3];  // see PixelOrigin in renderer/tracing/tracer.h
  PixelFloats frame[3][3];        // columns; the third is the shading normal
  PixelFloats out_direction[3];   // in the frame
  PixelFloats geometric_normal[3];
  PixelFloats diffuse_albedo[3], f0[3], f90, f0_dielectric, f90_dielectric, alpha, least_lifted,
      lifted_slope;  // Brdf in shaders/brdf.glsl

  PixelFloats from[3];   // origins of the rays of the direction at hand
  PixelFloats t, u, v;   // of the nearest candidate that a pixel's ray meets; t is infinite where there is none
  PixelWords candidate;  // which

  PixelFloats radiance[3];                             // that arrives along it, nit
  PixelFloats hit_position[3], hit_normal[3], is_lit;  // 1 where the candidate at hand may be lit, else 0

  PixelFloats sum[3];    // of light times weight, over the directions so far
  PixelFloats distance;  // sum over the hits, metres
  PixelFloats hit_count;
};

/// Consecutive pixels [begin, end) that refer to the same patch.
struct PixelRun {
  std::uint32_t begin, end;
};

/// A candidate as the rays of one direction see it: barycentrics and distance are affine in the origin
/// (Moeller and Trumbore 1997, with the triple products taken apart).
struct AffineTriangle {
  float corner[3], u[3], v[3], t[3];
};

/// A direction of a patch.
struct PatchDirection {
  float direction_ws[3];
  float pdf;  // 0: no ray
};

/// What a triangle reflects.
struct HitSurface {           // of words alone, so that lanes find their own
  float normals[3][3];        // at the corners; interpolated they need not be unit
  float geometric_normal[3];  // unit, by the winding
  float base_color[3];
  float metallic, roughness, f0_dielectric, specular_factor;
  float emission[3];      // nit
  float lit;              // 1; 0 where it neither reflects nor emits
  std::uint32_t is_flat;  // the normals are the same at all corners
};

/// A triangle that rays may meet.
struct Candidate {
  const HitSurface* surface;
  float side;  // 1 if the rays come from the geometric normal's side, else -1
};

/// Rays of pixels, directions and triangles that have nothing in common, one a lane, what they meet, and what comes of
/// it.
struct alignas(64) ScatteredRays {
  using Row = float[kMostLanes];
  std::uint32_t pixel[kMostLanes];  // in PatchPixels
  Row from[3];                      // origins, world space
  Row direction_ws[3], pdf;         // as PatchDirection
  Row t, u, v;                      // t is infinite where there is no hit
  Row side;                         // as Candidate
  HitSurface surfaces[kMostLanes];
  Row sum[3], distance;  // light times weight; of the hit, metres, or 0
};

/// Rays of some pixels along one direction, and what they meet.
struct alignas(64) ParallelRays {
  PixelWords pixel;  // in PatchPixels
  PixelFloats from[3];
  PixelFloats t, u, v;    // t is infinite where nothing is met
  PixelWords triangle;    // leaf of the hierarchy * kWide + which of its triangles
  float direction_ws[3];  // unit
  std::uint32_t count;    // up to kChunkPixels
};

/// Rays of pixels, and what they meet. Those along one direction share an entry.
struct alignas(64) SingleRays {
  static constexpr std::uint32_t kMost = 256, kMostEntries = 32;
  using Row = float[kMost];
  std::uint32_t pixel[kMost];  // in PatchPixels
  Row from[3];
  Row direction_ws[3], pdf;       // as PatchDirection
  Row t, u, v;                    // t is infinite where nothing is met
  std::uint32_t instance[kMost];  // in Pose::instances
  std::uint32_t triangle[kMost];  // in Primitive::indices / 3
  std::uint8_t entry[kMost];
  CompactEntry entries[kMostEntries];
  std::uint32_t count, entry_count;
};

/// `struct Light` of shaders/lights.glsl as std140 lays it out.
struct PackedLight {
  float position_ws[3];
  float inverse_range;
  float direction_ws[3];
  std::uint32_t kind;
  float intensity[3];
  float spot_scale;
  float spot_offset;
  float shadow_far_m;
  std::int32_t first_shadow_layer;
  float padding;
  float shadow_clip_from_world[4][4];  // columns
};
static_assert(sizeof(PackedLight) == 128);

/// What lights the hits, and what is seen where there are none.
struct LightEnvironment {
  const PackedLight* lights;
  std::uint32_t light_count;
  const float* shadow_moments;  // 2 a texel, row by row, layer by layer; readable for 2 texels beyond the last
  std::int32_t shadow_side_px;  // 2 or more
  float shadow_least_variance, shadow_cube_scale;
  float zenith_radiance[3], horizon_radiance[3], ground_radiance[3];  // nit
};

struct PatchKernels {
  const char* instructions;  // what processor they are for

  /// Fills all of `pixels` but the origins, and starts the sums.
  void (*unpack)(const PackedReceivers& packed, PatchPixels& pixels);
  /// Where the rays of a direction start. Nothing is met yet.
  void (*start_rays)(PatchPixels& pixels, PixelRun run, const PatchDirection& direction);
  /// Keeps the candidate where its triangle is met nearer than what is kept.
  void (*meet)(PatchPixels& pixels, PixelRun run, const AffineTriangle& triangle, std::uint32_t candidate);
  /// Makes rays of the pixels of the run that have met nothing.
  void (*collect_missed)(const PatchPixels& pixels, PixelRun run, ParallelRays& rays);
  /// Finds the nearest triangle on each of at least one ray.
  void (*nearest_hits)(const WideHierarchy& hierarchy, ParallelRays& rays);
  /// Where at least one ray comes into the hierarchy.
  void (*find_entry)(const CompactHierarchy& hierarchy, const ParallelRays& rays, CompactEntry& entry);
  /// Finds the nearest triangle on each ray, from its entry on.
  void (*nearest_single_hits)(const CompactHierarchy& hierarchy, SingleRays& rays);
  /// Adds to the sums what arrives from the candidates that are kept, and from the sky where there is none; nothing
  /// where t is negative.
  void (*gather)(PatchPixels& pixels, PixelRun run, const PatchDirection& direction, const Candidate* candidates,
                 std::uint32_t candidate_count, const LightEnvironment& environment);
  /// The same for `count` <= kMostLanes rays, but that it adds nothing to the pixels' sums.
  void (*gather_scattered)(const PatchPixels& pixels, ScatteredRays& rays, std::uint32_t count,
                           const LightEnvironment& environment);
};

}  // namespace lightwell::lanes
