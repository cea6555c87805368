// Compiled once for each kind of processor, LIGHTWELL_LANES_NAME being the table's name.
#if defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#if defined(__clang__)
#pragma GCC diagnostic ignored "-Wkeyword-macro"
#endif
#endif

#include "renderer/lanes/shading.h"

namespace lightwell::lanes {
namespace {

Ints lane_numbers() {
  Ints numbers;
  for (int i = 0; i < kLanes; ++i) numbers[i] = i;
  return numbers;
}
Mask in_run(std::uint32_t i, PixelRun run) {
  return less(lane_numbers(), Ints{} + static_cast<std::int32_t>(run.end - i));
}

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
    store_vec3(pixels.sum, i, vec3(0.0));
    store(&pixels.distance[i], Floats{});
    store(&pixels.hit_count[i], Floats{});
  }
}

Receiver receiver_of(const PatchPixels& pixels, std::uint32_t i) {
  Receiver receiver;
  for (int column = 0; column < 3; ++column) receiver.frame.columns[column] = load_vec3(pixels.frame[column], i);
  receiver.out_direction = load_vec3(pixels.out_direction, i);
  receiver.geometric_normal_ws = load_vec3(pixels.geometric_normal, i);
  receiver.brdf.diffuse_albedo = load_vec3(pixels.diffuse_albedo, i);
  receiver.brdf.f0 = load_vec3(pixels.f0, i);
  receiver.brdf.f90 = load_float(&pixels.f90[i]);
  receiver.brdf.f0_dielectric = load_float(&pixels.f0_dielectric[i]);
  receiver.brdf.f90_dielectric = load_float(&pixels.f90_dielectric[i]);
  receiver.brdf.alpha = load_float(&pixels.alpha[i]);
  return receiver;
}

constexpr float kNothing = __builtin_inff();

// Lanes beyond a run's end belong to the next run, which writes all its lanes anew, or to the padding.
void start_rays(PatchPixels& pixels, PixelRun run, const PatchDirection& direction) {
  const vec3 along = all_lanes(direction.direction_ws);
  for (std::uint32_t i = run.begin; i < run.end; i += kLanes) {
    const vec3 down = load_vec3(pixels.down, i);
    store_vec3(pixels.from, i, load_vec3(pixels.above, i) + select(dot(down, along) > 0.0, down, vec3(0.0)));
    store(&pixels.t[i], Float(kNothing).v);
  }
}

constexpr float kEdgeTolerance = 1e-6f;  // of barycentrics: rounding, so that no ray passes between two candidates

void meet(PatchPixels& pixels, PixelRun run, const AffineTriangle& triangle, std::uint32_t candidate) {
  const vec3 corner = all_lanes(triangle.corner);
  const vec3 u_axis = all_lanes(triangle.u), v_axis = all_lanes(triangle.v), t_axis = all_lanes(triangle.t);
  for (std::uint32_t i = run.begin; i < run.end; i += kLanes) {
    const vec3 way = load_vec3(pixels.from, i) - corner;
    const Float u = dot(way, u_axis), v = dot(way, v_axis), t = dot(way, t_axis);
    const Float t_before = load_float(&pixels.t[i]);
    const Mask nearer =
        u >= -kEdgeTolerance && v >= -kEdgeTolerance && u + v <= 1.0f + kEdgeTolerance && t > 0.0 && t < t_before;
    store(&pixels.t[i], select(nearer, t, t_before).v);
    store(&pixels.u[i], select(nearer, max(u, 0.0), load_float(&pixels.u[i])).v);
    store(&pixels.v[i], select(nearer, max(v, 0.0), load_float(&pixels.v[i])).v);
    const Ints number = Ints{} + static_cast<std::int32_t>(candidate);
    store(&pixels.candidate[i], select(nearer, number, load<Ints>(&pixels.candidate[i])));
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
  surfaces.lit = !from.unlit;
  return surfaces;
}

vec3 load_rows(const ScatteredRays::Row* from, std::uint32_t i) {
  return {load_float(&from[0][i]), load_float(&from[1][i]), load_float(&from[2][i])};
}

HitSurfaces surfaces_of(const ScatteredRays& rays, std::uint32_t i) {
  HitSurfaces surfaces;
  for (int corner = 0; corner < 3; ++corner) surfaces.normals[corner] = load_rows(rays.normals[corner], i);
  surfaces.geometric_normal = load_rows(rays.geometric_normal, i);
  surfaces.base_color = load_rows(rays.base_color, i);
  surfaces.emission = load_rows(rays.emission, i);
  surfaces.metallic = load_float(&rays.metallic[i]);
  surfaces.roughness = load_float(&rays.roughness[i]);
  surfaces.f0_dielectric = load_float(&rays.f0_dielectric[i]);
  surfaces.specular_factor = load_float(&rays.specular_factor[i]);
  surfaces.lit = load_float(&rays.lit[i]) > 0.0;
  return surfaces;
}

vec3 normals_of(const PatchPixels& pixels, std::uint32_t i, vec3 along, const HitSurfaces& surfaces) {
  const Float u = load_float(&pixels.u[i]), v = load_float(&pixels.v[i]);
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

void add_to_sum(PatchPixels& pixels, std::uint32_t i, vec3 light) {
  store_vec3(pixels.sum, i, load_vec3(pixels.sum, i) + light);
}

// Weights of the direction, distances of the hits, and the light of the sky.
__attribute__((flatten)) void weigh(PatchPixels& pixels, PixelRun run, const PatchDirection& direction,
                                    const LightEnvironment& environment) {
  const vec3 along = all_lanes(direction.direction_ws);
  for (std::uint32_t i = run.begin; i < run.end; i += kLanes) {
    const Float t = load_float(&pixels.t[i]);
    const Mask hit = in_run(i, run) && t >= 0.0 && t < kNothing;
    const Mask missed = in_run(i, run) && t >= kNothing;
    store(&pixels.distance[i], (load_float(&pixels.distance[i]) + select(hit, t, 0.0)).v);
    store(&pixels.hit_count[i], (load_float(&pixels.hit_count[i]) + select(hit, 1.0, 0.0)).v);
    const vec3 weight = select(hit || missed, weight_of(receiver_of(pixels, i), along, direction.pdf), vec3(0.0));
    store_vec3(pixels.weight, i, weight);
    if (any(missed)) add_to_sum(pixels, i, select(missed, weight * sky_of(environment, along.y), vec3(0.0)));
  }
}

// Where the rays that weigh something meet the candidate; adds its own light. False if none do.
__attribute__((flatten)) bool place_hits(PatchPixels& pixels, PixelRun run, vec3 along, std::uint32_t number,
                                         const HitSurfaces& surfaces, const vec3* flat_normal) {
  bool any_lit = false;
  for (std::uint32_t i = run.begin; i < run.end; i += kLanes) {
    const Float t = load_float(&pixels.t[i]);
    const vec3 weight = load_vec3(pixels.weight, i);
    const Mask of_candidate = equal(load<Ints>(&pixels.candidate[i]), Ints{} + static_cast<std::int32_t>(number));
    const Mask lit = of_candidate && t >= 0.0 && t < kNothing && weight.x + weight.y + weight.z > 0.0 && surfaces.lit;
    store(&pixels.is_lit[i], select(lit, 1.0, 0.0).v);
    if (!any(lit)) continue;
    any_lit = true;
    store_vec3(pixels.hit_position, i, load_vec3(pixels.from, i) + select(lit, t, 0.0) * along);
    store_vec3(pixels.hit_normal, i, flat_normal ? *flat_normal : normals_of(pixels, i, along, surfaces));
    add_to_sum(pixels, i, select(lit, weight * surfaces.emission, vec3(0.0)));
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
    add_to_sum(pixels, i, select(lit, load_vec3(pixels.weight, i) * arriving, vec3(0.0)));
  }
}

// As main() in passes/gather.comp over light_of_hit() in passes/hit_light.comp.
void gather(PatchPixels& pixels, PixelRun run, const PatchDirection& direction, const Candidate* candidates,
            std::uint32_t candidate_count, const LightEnvironment& environment) {
  const vec3 along = all_lanes(direction.direction_ws);
  weigh(pixels, run, direction, environment);
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
}

__attribute__((flatten)) void gather_scattered(PatchPixels& pixels, const ScatteredRays& rays, std::uint32_t count,
                                               const LightEnvironment& environment) {
  Lighting lighting(environment);
  const PixelRun run{0, count};
  for (std::uint32_t i = 0; i < count; i += kLanes) {
    const vec3 along = load_rows(rays.direction_ws, i);
    const Float t = load_float(&pixels.t[i]);
    const Mask hit = in_run(i, run) && t < kNothing;
    store(&pixels.distance[i], (load_float(&pixels.distance[i]) + select(hit, t, 0.0)).v);
    store(&pixels.hit_count[i], (load_float(&pixels.hit_count[i]) + select(hit, 1.0, 0.0)).v);
    const vec3 weight = weight_of(receiver_of(pixels, i), along, load_float(&rays.pdf[i]));
    const Mask weighs = in_run(i, run) && weight.x + weight.y + weight.z > 0.0;
    const HitSurfaces surfaces = surfaces_of(rays, i);
    const vec3 position_ws = load_vec3(pixels.from, i) + select(hit, t, 0.0) * along;
    const vec3 reflected = lighting.reflected(hit && weighs, brdf_of(surfaces), position_ws,
                                              normals_of(pixels, i, along, surfaces), -along);
    const vec3 from_hits = select(surfaces.lit, surfaces.emission + reflected, vec3(0.0));
    const vec3 light = select(hit, from_hits, sky_of(environment, along.y));
    store_vec3(pixels.sum, i, load_vec3(pixels.sum, i) + select(weighs, weight * light, vec3(0.0)));
  }
}

#if defined(__AVX512F__) && defined(__AVX512DQ__)
constexpr const char* kInstructions = "AVX-512";
#elif defined(__AVX2__)
constexpr const char* kInstructions = "AVX2";
#else
constexpr const char* kInstructions = "plain";
#endif

}  // namespace

extern const PatchKernels LIGHTWELL_LANES_NAME;
const PatchKernels LIGHTWELL_LANES_NAME = {kInstructions, unpack, start_rays, meet, gather, gather_scattered};

}  // namespace lightwell::lanes
