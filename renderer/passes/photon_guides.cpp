#include "renderer/passes/photon_guides.h"

#include <algorithm>
#include <utility>

#include "renderer/passes/bindings.glsl"

namespace lightwell {

namespace {

constexpr std::uint32_t kPhotons = 1u << 14;  // at most 2^16: a place of a cell has half a word for one
constexpr std::uint32_t kSurfaces = 3;        // that a photon may meet: mirrors and a matt one
constexpr std::uint32_t kFramesBetween = 16;  // new photons find other points

// The scene's diagonal over a cell's side. With half or twice as many a picture has at most a tenth more error.
constexpr float kCellsAcross = 32.0f;

// Of the light that comes to matt surfaces otherwise, as a share of what they would have if all that the lights emit
// came to the sides of the scene's bounding box. Between a tenth and a third the error is the same within a tenth.
constexpr double kUsualShare = 0.2;

constexpr GLbitfield kBetweenStages = GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT;

struct StartProgram {
  explicit StartProgram(gl::ProgramPtr p)
      : program(std::move(p)),
        lights(program),
        photon_count(program, "photon_count"),
        seed(program, "seed"),
        beyond_scene_m(program, "beyond_scene_m") {}
  gl::ProgramPtr program;
  LightTableUniforms lights;
  gl::Uniform<std::uint32_t> photon_count, seed;
  gl::Uniform<float> beyond_scene_m;
};

struct BounceProgram {
  explicit BounceProgram(gl::ProgramPtr p)
      : program(std::move(p)),
        photon_count(program, "photon_count"),
        bounce(program, "bounce"),
        seed(program, "seed"),
        cell_m(program, "guide_cell_m"),
        flux_scale(program, "flux_scale") {}
  gl::ProgramPtr program;
  gl::Uniform<std::uint32_t> photon_count, bounce, seed;
  gl::Uniform<float> cell_m, flux_scale;
};

struct Flight {
  explicit Flight(gl::BufferUse use)
      : rays("photon rays", std::uint64_t{kPhotons} * sizeof(Ray), use),
        fluxes("photon fluxes", std::uint64_t{kPhotons} * sizeof(glm::vec4)),
        ray_texels("photon rays", GL_RGBA32F),
        flux_texels("photon fluxes", GL_RGBA32F) {
    ray_texels.attach(rays);
    flux_texels.attach(fluxes);
  }
  gl::Buffer rays, fluxes;
  gl::BufferTexture ray_texels, flux_texels;
};

}  // namespace

struct PhotonGuidesPass::Programs {
  explicit Programs(gl::ShaderLibrary& shaders)
      : start([&shaders](const gl::Defines& defines) { return shaders.compute("passes/photon_start.comp", defines); }),
        bounce(
            [&shaders](const gl::Defines& defines) { return shaders.compute("passes/photon_bounce.comp", defines); }) {}
  gl::Variants<StartProgram> start;
  gl::Variants<BounceProgram> bounce;
};

struct PhotonGuidesPass::Photons {
  explicit Photons(gl::BufferUse use)
      : from(std::make_unique<Flight>(use)),
        to(std::make_unique<Flight>(use)),
        hits("photon hits", std::uint64_t{kPhotons} * sizeof(Hit), use),
        targets("photon targets", std::uint64_t{kPhotons} * sizeof(PhotonTarget)),
        origins("photon origins", std::uint64_t{kPhotons} * sizeof(glm::vec4)),
        cells("guide cells", std::uint64_t{GUIDE_CELLS} * GUIDES_PER_CELL * 4),
        cell_fluxes("guide fluxes", std::uint64_t{GUIDE_CELLS} * 4) {
    cell_flux_texels.attach(cell_fluxes);
    hit_texels.attach(hits);
    target_texels.attach(targets);
    origin_texels.attach(origins);
    cell_texels.attach(cells);
  }
  std::unique_ptr<Flight> from, to;
  gl::Buffer hits, targets, origins, cells, cell_fluxes;
  gl::BufferTexture hit_texels{"photon hits", GL_RGBA32UI}, target_texels{"photon targets", GL_RGBA32F},
      origin_texels{"photon origins", GL_RGBA32F}, cell_texels{"guide cells", GL_RGBA32UI},
      cell_flux_texels{"guide fluxes", GL_R32UI};
};

PhotonGuidesPass::PhotonGuidesPass(gl::ShaderLibrary& shaders, gl::BufferUse buffers)
    : programs_(std::make_unique<Programs>(shaders)), photons_(std::make_unique<Photons>(buffers)) {}

PhotonGuidesPass::~PhotonGuidesPass() = default;

void PhotonGuidesPass::run(FrameContext& frame, const Scene& scene, const LightTable& lights,
                           const gl::Defines& defines) {
  const bool wanted = frame.settings.photon_guides && frame.settings.bounces > 0;  // else no path goes on
  has_guides_ = has_guides_ && wanted;
  if (frame.frame_number % kFramesBetween != 0 || !wanted) return;
  seed_ = frame.settings.seed * 0x9e3779b9u + frame.frame_number;
  const std::vector<PhotonTarget> targets = photon_targets(scene, frame.pose, kPhotons, seed_);
  has_guides_ = !targets.empty() && lights.counts().lights > 0;
  if (!has_guides_) return;
  photons_->targets.upload(std::span<const PhotonTarget>(targets));
  set_scale(frame.pose, lights);
  start(lights, defines);
  for (std::uint32_t i = 0; i < kSurfaces; ++i) {
    frame.tracer.closest_hit(photons_->to->rays, kPhotons, photons_->hits);
    frame.rays += kPhotons;
    bounce(defines, i);
  }
  frame.timer.mark("photons");
}

void PhotonGuidesPass::set_scale(const Pose& pose, const LightTable& lights) {
  const glm::dvec3 size_m = glm::dvec3(pose.bounds_max) - glm::dvec3(pose.bounds_min);
  cell_m_ = std::max(static_cast<float>(glm::length(size_m)) / kCellsAcross, 1e-6f);
  const double sides_m2 = 2.0 * (size_m.x * size_m.y + size_m.y * size_m.z + size_m.z * size_m.x);
  const double usual_irradiance = kUsualShare * lights.power() / std::max(sides_m2, 1e-30);
  const double usual_flux = usual_irradiance * static_cast<double>(cell_m_) * static_cast<double>(cell_m_);
  flux_scale_ = static_cast<float>(1.0 / std::clamp(usual_flux, 1e-30, 1e30));
}

void PhotonGuidesPass::start(const LightTable& lights, const gl::Defines& defines) {
  const StartProgram& program = programs_->start.with(defines);
  program.lights.set(lights.counts());
  program.photon_count = kPhotons;
  program.seed = seed_;
  program.beyond_scene_m = 2.0f * kCellsAcross * cell_m_;
  photons_->cells.clear(~0u);
  photons_->cell_fluxes.clear();
  photons_->target_texels.bind(UNIT_PHOTON_TARGETS);
  photons_->to->rays.bind_storage(BINDING_PHOTON_RAYS);
  photons_->to->fluxes.bind_storage(BINDING_PHOTON_FLUXES);
  program.program->dispatch(kPhotons);
  glMemoryBarrier(kBetweenStages);
}

void PhotonGuidesPass::bounce(const gl::Defines& defines, std::uint32_t bounce) {
  const BounceProgram& program = programs_->bounce.with(defines);
  Photons& p = *photons_;
  std::swap(p.from, p.to);
  program.photon_count = kPhotons;
  program.bounce = bounce;
  program.seed = seed_;
  program.cell_m = cell_m_;
  program.flux_scale = flux_scale_;
  p.cell_fluxes.bind_storage(BINDING_GUIDE_FLUXES);
  p.from->ray_texels.bind(UNIT_RAYS);
  p.from->flux_texels.bind(UNIT_PHOTON_FLUXES);
  p.hit_texels.bind(UNIT_HITS);
  p.to->rays.bind_storage(BINDING_PHOTON_RAYS);
  p.to->fluxes.bind_storage(BINDING_PHOTON_FLUXES);
  p.origins.bind_storage(BINDING_PHOTON_ORIGINS);
  p.cells.bind_storage(BINDING_GUIDE_CELLS);
  program.program->dispatch(kPhotons);
  glMemoryBarrier(kBetweenStages);
}

void PhotonGuidesPass::bind() const {
  photons_->cell_texels.bind(UNIT_GUIDE_CELLS);
  photons_->cell_flux_texels.bind(UNIT_GUIDE_FLUXES);
  photons_->origin_texels.bind(UNIT_PHOTON_ORIGINS);
}

}  // namespace lightwell
