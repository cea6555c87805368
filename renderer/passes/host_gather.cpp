#include "renderer/passes/host_gather.h"

#include <algorithm>
#include <atomic>

#include "renderer/check.h"
#include "renderer/passes/host_chunk.h"

namespace lightwell {

// What the kernels are given, and what it points to.
struct HostGatherPass::Lights {
  std::vector<lanes::PackedLight> punctual;
  std::vector<float> shadow_moments;
  lanes::LightEnvironment environment;
};

namespace {

using lanes::assign;

template <class T>
const T* host_of(const gl::Buffer& buffer) {
  LIGHTWELL_CHECK(buffer.host() != nullptr);
  return reinterpret_cast<const T*>(buffer.host());
}

}  // namespace

HostGatherPass::HostGatherPass() : lights_(std::make_unique<Lights>()) {}
HostGatherPass::~HostGatherPass() = default;

bool HostGatherPass::knows(const DeviceScene& scene) {
  return scene.texture_defines().empty() && scene.brdf_defines().empty() && scene.environment_defines().empty() &&
         !scene.has_tinted_shadows() && !scene.has_coverage();
}

void HostGatherPass::begin(const DeviceScene& scene, const ShadowMaps& shadows) {
  struct Header {
    std::uint32_t light_count;
    float shadow_least_variance, shadow_cube_scale;
    std::uint32_t padding;
  } header;
  shadows.lights.download(std::as_writable_bytes(std::span(&header, 1)));
  lights_->punctual.resize(header.light_count);
  shadows.lights.download(std::as_writable_bytes(std::span(lights_->punctual)), sizeof header);

  const int side = shadows.moments.size_px().x;
  const std::size_t floats = std::size_t{2} * side * side * shadows.moments.layers();
  lights_->shadow_moments.resize(floats + 4);
  glGetTextureImage(shadows.moments.id(), 0, GL_RG, GL_FLOAT, static_cast<GLsizei>(floats * sizeof(float)),
                    lights_->shadow_moments.data());

  lanes::LightEnvironment& environment = lights_->environment;
  environment.lights = lights_->punctual.data();
  environment.light_count = header.light_count;
  environment.shadow_moments = lights_->shadow_moments.data();
  environment.shadow_side_px = side;
  environment.shadow_least_variance = header.shadow_least_variance;
  environment.shadow_cube_scale = header.shadow_cube_scale;
  const Environment& sky = scene.environment();
  assign(environment.zenith_radiance, sky.zenith_radiance * sky.strength);
  assign(environment.horizon_radiance, sky.horizon_radiance * sky.strength);
  assign(environment.ground_radiance, sky.ground_radiance * sky.strength);
}

std::uint64_t HostGatherPass::run(const DeviceScene& scene, HostTracer& tracer, const Batch& batch) {
  const Directions& directions = batch.rays.directions;
  const WideHierarchy* const wide = batch.trace_missed ? tracer.wide_hierarchy() : nullptr;
  const HostBatch host{host_of<PixelOrigin>(batch.rays.patches.pixel_origins),
                       host_of<PackedReceiver>(batch.rays.patches.receivers),
                       host_of<lanes::PatchDirection>(directions.directions),
                       host_of<Hit>(batch.candidates),
                       batch.rays.patches.count,
                       directions.count,
                       batch.group_count,
                       batch.trace_missed,
                       scene.host_hit_data(),
                       lights_->environment,
                       tracer,
                       wide,
                       batch.trace_missed && !wide ? tracer.compact_hierarchy() : nullptr};
  gl::wait_for_device();
  if (sums_.reserve(std::uint64_t{batch.rays.slots} * sizeof(glm::vec4))) sum_texels_.attach(sums_);
  auto* sums = reinterpret_cast<glm::vec4*>(sums_.host());
  TriangleCaches caches(host.scene, tracer);
  std::atomic<std::uint64_t> traced = 0;
  constexpr std::uint32_t kPixelsAtOnce = 4 * lanes::kChunkPixels;
  tracer.parallel_for(batch.rays.slots, kPixelsAtOnce, [&](std::uint32_t begin, std::uint32_t end) {
    std::unique_ptr<TriangleCache> triangles = caches.take();
    for (std::uint32_t first = begin; first < end; first += lanes::kChunkPixels) {
      HostChunk chunk(host, *triangles, first, std::min(first + lanes::kChunkPixels, end));
      chunk.run();
      chunk.add_to(sums, directions.first == 0);
      traced += chunk.traced();
    }
    caches.give_back(std::move(triangles));
  });
  return traced;
}

}  // namespace lightwell
