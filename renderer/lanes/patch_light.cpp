// Compiled once for each kind of processor, LIGHTWELL_LANES_PREFIX being what the table's name begins with.
#if defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#if defined(__clang__)
#pragma GCC diagnostic ignored "-Wkeyword-macro"
#endif
#endif

#include "renderer/lanes/compact_entry.h"
#include "renderer/lanes/compact_walk.h"
#include "renderer/lanes/hierarchy_walk.h"
#include "renderer/lanes/shading.h"

namespace lightwell::lanes {
namespace {

vec2 unpack_snorm(Ints words) {
  const auto unpacked = [](Ints halves) { return max(to_float(halves) * (1.0 / 32767.0), -1.0); };
  return {unpacked((words << 16) >> 16), unpacked(words >> 16)};
}
vec2 unpack_unorm(Ints words) {
  return {to_float(words & 0xffff) * (1.0 / 65535.0), to_float((words >> 16) & 0xffff) * (1.0 / 65535.0)};
}

// As g_buffer_point() in shaders/g_buffer.glsl.
void unpack(const PackedReceivers& packed, PatchPixels& pixels) {
  for (std::uint32_t i = 0; i < kChunkPixels; i += kLanes) {
    const auto words = [i](const PixelWords& from) { return load<Ints>(&from[i]); };
    const mat3 frame = frame_around(unit_from_octahedral(unpack_snorm(words(packed.normal))));
    for (int column = 0; column < 3; ++column) store_vec3(pixels.frame[column], i, frame.columns[column]);
    store_vec3(pixels.out_direction, i, unit_from_octahedral(unpack_snorm(words(packed.to_camera))) * frame);
    store_vec3(pixels.geometric_normal, i, unit_from_octahedral(unpack_snorm(words(packed.geometric_normal))));
    const vec2 red_green = unpack_unorm(words(packed.base_color_rg));
    const vec2 blue_metallic = unpack_unorm(words(packed.base_color_b_metallic));
    const vec2 dielectric = unpack_unorm(words(packed.dielectric));
    const Brdf brdf = make_brdf(vec3(red_green, blue_metallic.x), blue_metallic.y,
                                unpack_unorm(words(packed.material_roughness)).y, dielectric.x, dielectric.y);
    store_vec3(pixels.diffuse_albedo, i, brdf.diffuse_albedo);
    store_vec3(pixels.f0, i, brdf.f0);
    store(&pixels.f90[i], brdf.f90.v);
    store(&pixels.f0_dielectric[i], brdf.f0_dielectric.v);
    store(&pixels.f90_dielectric[i], brdf.f90_dielectric.v);
    store(&pixels.alpha[i], brdf.alpha.v);
    store(&pixels.least_lifted[i], brdf.least_lifted.v);
    store(&pixels.lifted_slope[i], brdf.lifted_slope.v);
    store_vec3(pixels.sum, i, vec3(0.0));
    store(&pixels.distance[i], Floats{});
    store(&pixels.hit_count[i], Floats{});
  }
}

// `row` and `vector` read rows of PatchPixels.
template <class Row, class Vector>
Receiver receiver_of(const PatchPixels& pixels, const Row& row, const Vector& vector) {
  Receiver receiver;
  for (int column = 0; column < 3; ++column) receiver.frame.columns[column] = vector(pixels.frame[column]);
  receiver.out_direction = vector(pixels.out_direction);
  receiver.geometric_normal_ws = vector(pixels.geometric_normal);
  receiver.brdf.diffuse_albedo = vector(pixels.diffuse_albedo);
  receiver.brdf.f0 = vector(pixels.f0);
  receiver.brdf.f90 = row(pixels.f90);
  receiver.brdf.f0_dielectric = row(pixels.f0_dielectric);
  receiver.brdf.f90_dielectric = row(pixels.f90_dielectric);
  receiver.brdf.alpha = row(pixels.alpha);
  receiver.brdf.least_lifted = row(pixels.least_lifted);
  receiver.brdf.lifted_slope = row(pixels.lifted_slope);
  return receiver;
}
Receiver receiver_at(const PatchPixels& pixels, std::uint32_t i) {
  return receiver_of(
      pixels, [i](const float* from) { return load_float(&from[i]); },
      [i](const PixelFloats* from) { return load_vec3(from, i); });
}
Receiver receivers_of(const PatchPixels& pixels, Ints places) {
  return receiver_of(
      pixels, [places](const float* from) { return gathered(from, places); },
      [places](const PixelFloats* from) { return gathered_vec3(from, places); });
}

// Lanes beyond a run's end belong to the next run, which writes all its lanes anew, or to the padding.
void start_rays(PatchPixels& pixels, PixelRun run, const PatchDirection& direction) {
  const vec3 along = all_lanes(direction.direction_ws);
  for (std::uint32_t i = run.begin; i < run.end; i += kLanes) {
    const vec3 down = load_vec3(pixels.down, i);
    store_vec3(pixels.from, i, load_vec3(pixels.above, i) + select(dot(down, along) > 0.0, down, vec3(0.0)));
    store(&pixels.t[i], Float(kNothing).v);
  }
}

void meet(PatchPixels& pixels, PixelRun run, const AffineTriangle& triangle, std::uint32_t candidate) {
  meet_rays(pixels.from, {pixels.t, pixels.u, pixels.v, pixels.candidate}, run, triangle, candidate);
}

void collect_missed(const PatchPixels& pixels, PixelRun run, ParallelRays& rays) {
  rays.count = 0;
  for (std::uint32_t i = run.begin; i < run.end; i += kLanes) {
    const Mask missed = in_run(i, run) && !(load_float(&pixels.t[i]) < kNothing);
    for (std::uint32_t lanes = lane_bits(missed); lanes != 0; lanes &= lanes - 1) {
      const std::uint32_t pixel = i + static_cast<std::uint32_t>(__builtin_ctz(lanes));
      for (int axis = 0; axis < 3; ++axis) rays.from[axis][rays.count] = pixels.from[axis][pixel];
      rays.pixel[rays.count++] = pixel;
    }
  }
}

// What hits need to know of their triangles.
struct HitSurfaces {
  vec3 normals[3], geometric_normal;  // on the side that the rays come from
  vec3 base_color, emission;
  Float metallic, roughness, f0_dielectric, specular_factor;
  Mask lit;
};

HitSurfaces all_lanes(const Candidate& candidate) {
  const HitSurface& from = *candidate.surface;
  HitSurfaces surfaces;
  for (int corner = 0; corner < 3; ++corner)
    surfaces.normals[corner] = all_lanes(from.normals[corner]) * candidate.side;
  surfaces.geometric_normal = all_lanes(from.geometric_normal) * candidate.side;
  surfaces.base_color = all_lanes(from.base_color);
  surfaces.emission = all_lanes(from.emission);
  surfaces.metallic = from.metallic;
  surfaces.roughness = from.roughness;
  surfaces.f0_dielectric = from.f0_dielectric;
  surfaces.specular_factor = from.specular_factor;
  surfaces.lit = from.lit > 0.0f;
  return surfaces;
}

vec3 load_rows(const ScatteredRays::Row* from, std::uint32_t i) {
  return {load_float(&from[0][i]), load_float(&from[1][i]), load_float(&from[2][i])};
}

HitSurfaces surfaces_of(const ScatteredRays& rays, std::uint32_t i) {
  constexpr std::int32_t kStride = sizeof(HitSurface) / sizeof(float);
  const Ints first = lane_numbers() * kStride;
  const HitSurface& from = rays.surfaces[i];
  const auto vector = [&](const float* member) {
    return vec3(gathered(member, first), gathered(member + 1, first), gathered(member + 2, first));
  };
  const Float side = load_float(&rays.side[i]);
  HitSurfaces surfaces;
  for (int corner = 0; corner < 3; ++corner) surfaces.normals[corner] = vector(from.normals[corner]) * side;
  surfaces.geometric_normal = vector(from.geometric_normal) * side;
  surfaces.base_color = vector(from.base_color);
  surfaces.emission = vector(from.emission);
  surfaces.metallic = gathered(&from.metallic, first);
  surfaces.roughness = gathered(&from.roughness, first);
  surfaces.f0_dielectric = gathered(&from.f0_dielectric, first);
  surfaces.specular_factor = gathered(&from.specular_factor, first);
  surfaces.lit = gathered(&from.lit, first) > 0.0;
  return surfaces;
}

vec3 normals_of(Float u, Float v, vec3 along, const HitSurfaces& surfaces) {
  const vec3 interpolated =
      normalize(surfaces.normals[0] * (1.0 - u - v) + surfaces.normals[1] * u + surfaces.normals[2] * v);
  return visible_shading_normal(interpolated, surfaces.geometric_normal, -along);
}

Brdf brdf_of(const HitSurfaces& surfaces) {
  return make_brdf(surfaces.base_color, surfaces.metallic, surfaces.roughness, surfaces.f0_dielectric,
                   surfaces.specular_factor);
}

vec3 sky_of(const LightEnvironment& environment, Float up) {
  return sky_gradient(all_lanes(environment.zenith_radiance), all_lanes(environment.horizon_radiance),
                      all_lanes(environment.ground_radiance), up);
}

void add_radiance(PatchPixels& pixels, std::uint32_t i, vec3 radiance) {
  store_vec3(pixels.radiance, i, load_vec3(pixels.radiance, i) + radiance);
}

// Distances of the hits, and the light of the sky where there are none.
__attribute__((flatten)) void see_sky(PatchPixels& pixels, PixelRun run, vec3 along,
                                      const LightEnvironment& environment) {
  const vec3 sky = sky_of(environment, along.y);
  for (std::uint32_t i = run.begin; i < run.end; i += kLanes) {
    const Float t = load_float(&pixels.t[i]);
    const Mask hit = in_run(i, run) && t >= 0.0 && t < kNothing;
    const Mask missed = in_run(i, run) && t >= kNothing;
    store(&pixels.distance[i], (load_float(&pixels.distance[i]) + select(hit, t, 0.0)).v);
    store(&pixels.hit_count[i], (load_float(&pixels.hit_count[i]) + select(hit, 1.0, 0.0)).v);
    store_vec3(pixels.radiance, i, select(missed, sky, vec3(0.0)));
  }
}

// Where rays meet the candidate; adds its own light. False if none do.
__attribute__((flatten)) bool place_hits(PatchPixels& pixels, PixelRun run, vec3 along, std::uint32_t number,
                                         const HitSurfaces& surfaces, const vec3* flat_normal) {
  bool any_lit = false;
  for (std::uint32_t i = run.begin; i < run.end; i += kLanes) {
    const Float t = load_float(&pixels.t[i]);
    const Mask of_candidate = equal(load<Ints>(&pixels.candidate[i]), Ints{} + static_cast<std::int32_t>(number));
    const Mask lit = in_run(i, run) && of_candidate && t >= 0.0 && t < kNothing && surfaces.lit;
    store(&pixels.is_lit[i], select(lit, 1.0, 0.0).v);
    if (!any(lit)) continue;
    any_lit = true;
    store_vec3(pixels.hit_position, i, load_vec3(pixels.from, i) + select(lit, t, 0.0) * along);
    store_vec3(
        pixels.hit_normal, i,
        flat_normal ? *flat_normal : normals_of(load_float(&pixels.u[i]), load_float(&pixels.v[i]), along, surfaces));
    add_radiance(pixels, i, select(lit, surfaces.emission, vec3(0.0)));
  }
  return any_lit;
}

// Adds what a light brings by the hits of the candidate at hand. Nothing is done where it reaches none from the front;
// of a light without a place and a flat triangle all but the shadow is the same for all.
__attribute__((flatten)) void add_light(PatchPixels& pixels, PixelRun run, vec3 out_ws, const Brdf& brdf,
                                        Lighting& lighting, const Lighting::Light& light, const vec3* flat_normal) {
  const bool is_even = flat_normal != nullptr && light.kind == 0;
  vec3 even_light(0.0);
  if (is_even) {
    const Lighting::LightSample at = lighting.light_at(light, vec3(0.0));
    even_light = brdf_times_cosine(brdf, *flat_normal, out_ws, at.to_light_ws) * at.irradiance;
    if (!any(even_light.x + even_light.y + even_light.z > 0.0)) return;
  }
  for (std::uint32_t i = run.begin; i < run.end; i += kLanes) {
    const Mask lit = load_float(&pixels.is_lit[i]) > 0.0;
    if (!any(lit)) continue;
    const vec3 position_ws = load_vec3(pixels.hit_position, i), normal_ws = load_vec3(pixels.hit_normal, i);
    const Lighting::LightSample at = lighting.light_at(light, position_ws);
    const Float most = max(at.irradiance.x, max(at.irradiance.y, at.irradiance.z));
    if (!any(lit && most > 0.0 && dot(normal_ws, at.to_light_ws) > 0.0)) continue;
    const vec3 reflected =
        is_even ? even_light : brdf_times_cosine(brdf, normal_ws, out_ws, at.to_light_ws) * at.irradiance;
    const vec3 arriving = reflected * lighting.light_visibility(light, position_ws, normal_ws, at.to_light_ws);
    add_radiance(pixels, i, select(lit, arriving, vec3(0.0)));
  }
}

// Most directions of many pixels meet what is dark.
__attribute__((flatten)) void weigh(PatchPixels& pixels, PixelRun run, vec3 along, float pdf) {
  for (std::uint32_t i = run.begin; i < run.end; i += kLanes) {
    const vec3 radiance = load_vec3(pixels.radiance, i);
    const Mask bright = radiance.x + radiance.y + radiance.z > 0.0;
    if (!any(bright)) continue;
    const vec3 light = weight_of(receiver_at(pixels, i), along, pdf) * radiance;
    store_vec3(pixels.sum, i, load_vec3(pixels.sum, i) + select(bright, light, vec3(0.0)));
  }
}

// As main() in passes/gather.comp over light_of_hit() in passes/hit_light.comp.
void gather(PatchPixels& pixels, PixelRun run, const PatchDirection& direction, const Candidate* candidates,
            std::uint32_t candidate_count, const LightEnvironment& environment) {
  const vec3 along = all_lanes(direction.direction_ws);
  see_sky(pixels, run, along, environment);
  Lighting lighting(environment);
  for (std::uint32_t number = 0; number < candidate_count; ++number) {
    const HitSurfaces surfaces = all_lanes(candidates[number]);
    const vec3 flat_normal = visible_shading_normal(normalize(surfaces.normals[0]), surfaces.geometric_normal, -along);
    const vec3* const flat = candidates[number].surface->is_flat ? &flat_normal : nullptr;
    if (!place_hits(pixels, run, along, number, surfaces, flat)) continue;
    const Brdf brdf = brdf_of(surfaces);
    for (std::uint32_t i = 0; i < environment.light_count; ++i)
      add_light(pixels, run, -along, brdf, lighting, Lighting::light_of(environment.lights[i]), flat);
  }
  weigh(pixels, run, along, direction.pdf);
}

__attribute__((flatten)) void gather_scattered(const PatchPixels& pixels, ScatteredRays& rays, std::uint32_t count,
                                               const LightEnvironment& environment) {
  Lighting lighting(environment);
  for (std::uint32_t i = 0; i < count; i += kLanes) {
    const Mask used = in_run(i, {0, count});
    const Ints places = load<Ints>(&rays.pixel[i]);
    const vec3 along = load_rows(rays.direction_ws, i);
    const Float t = load_float(&rays.t[i]);
    const Mask hit = used && t < kNothing;
    const vec3 weight = weight_of(receivers_of(pixels, places), along, load_float(&rays.pdf[i]));
    const Mask weighs = used && weight.x + weight.y + weight.z > 0.0;
    const HitSurfaces surfaces = surfaces_of(rays, i);
    const vec3 position_ws = load_rows(rays.from, i) + select(hit, t, 0.0) * along;
    const vec3 normal_ws = normals_of(load_float(&rays.u[i]), load_float(&rays.v[i]), along, surfaces);
    const vec3 reflected = lighting.reflected(hit && weighs, brdf_of(surfaces), position_ws, normal_ws, -along);
    const vec3 from_hits = select(surfaces.lit, surfaces.emission + reflected, vec3(0.0));
    const vec3 sum = select(weighs, weight * select(hit, from_hits, sky_of(environment, along.y)), vec3(0.0));
    store(&rays.sum[0][i], sum.x.v), store(&rays.sum[1][i], sum.y.v), store(&rays.sum[2][i], sum.z.v);
    store(&rays.distance[i], select(hit, t, 0.0).v);
  }
}

}  // namespace

extern const PatchKernels LIGHTWELL_LANES_TABLE(PatchKernels);
const PatchKernels LIGHTWELL_LANES_TABLE(PatchKernels) = {
    kInstructions, unpack,     start_rays,          meet,   collect_missed,
    nearest_hits,  find_entry, nearest_single_hits, gather, gather_scattered};

}  // namespace lightwell::lanes
