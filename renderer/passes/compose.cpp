#include "renderer/passes/compose.h"

#include <cmath>
#include <cstring>

#include "renderer/passes/bindings.glsl"

namespace lightwell {

namespace {

// std140 mirror of EnvironmentBlock in shaders/environment.glsl.
struct DeviceEnvironment {
  glm::vec4 zenith_rotation;
  glm::vec4 horizon_strength;
  glm::vec4 ground_image;
  glm::vec4 background;
};

bool is_of_light(ViewKind view) {
  return view == ViewKind::kFinal || view == ViewKind::kDirect || view == ViewKind::kIndirect ||
         view == ViewKind::kBounce;
}

// The shaders' names of the views.
constexpr bool is(ViewKind view, int value) {
  return static_cast<int>(view) == value;
}
static_assert(is(ViewKind::kFinal, VIEW_FINAL) && is(ViewKind::kDirect, VIEW_DIRECT) &&
              is(ViewKind::kIndirect, VIEW_INDIRECT) && is(ViewKind::kAlbedo, VIEW_ALBEDO) &&
              is(ViewKind::kNormal, VIEW_NORMAL) && is(ViewKind::kDepth, VIEW_DEPTH) &&
              is(ViewKind::kOcclusionDistance, VIEW_OCCLUSION_DISTANCE) && is(ViewKind::kPosition, VIEW_POSITION) &&
              is(ViewKind::kNormalDepth, VIEW_NORMAL_DEPTH) && is(ViewKind::kBounce, VIEW_BOUNCE) &&
              is(ViewKind::kDirection, VIEW_DIRECTION) && is(ViewKind::kHitDistance, VIEW_HIT_DISTANCE) &&
              is(ViewKind::kPatch, VIEW_PATCH) && is(ViewKind::kReference, VIEW_REFERENCE) &&
              is(ViewKind::kCandidates, VIEW_CANDIDATES) && is(ViewKind::kUnmatched, VIEW_UNMATCHED) &&
              is(ViewKind::kHistory, VIEW_HISTORY) && is(ViewKind::kVariance, VIEW_VARIANCE) &&
              is(ViewKind::kGradient, VIEW_GRADIENT) && is(ViewKind::kMotion, VIEW_MOTION) &&
              is(ViewKind::kCacheCells, VIEW_CACHE_CELLS));

// How display.comp shows a view's values.
int mapping_of(ViewKind view) {
  enum { kExposed, kAsItIs, kDistance, kRepeating, kSigned };
  switch (view) {
    case ViewKind::kFinal:
    case ViewKind::kDirect:
    case ViewKind::kIndirect:
    case ViewKind::kBounce:
      return kExposed;
    case ViewKind::kDepth:
    case ViewKind::kOcclusionDistance:
    case ViewKind::kHitDistance:
      return kDistance;
    case ViewKind::kPosition:
      return kRepeating;
    case ViewKind::kDirection:
      return kSigned;
    default:
      return kAsItIs;
  }
}

struct DeviceExposure {
  float exposure;
  float exposure_ev;
  std::uint32_t measured;
};

}  // namespace

bool shows_clear_surfaces(ViewKind view) {
  switch (view) {
    case ViewKind::kAlbedo:
    case ViewKind::kNormal:
    case ViewKind::kDepth:
    case ViewKind::kPosition:
    case ViewKind::kNormalDepth:
      return true;
    default:
      return is_of_light(view);
  }
}

EnvironmentBlock::EnvironmentBlock() : block_("environment", sizeof(DeviceEnvironment)) {}

void EnvironmentBlock::set(const Environment& environment, const std::optional<glm::vec3>& background) {
  const bool has_image = environment.image && !environment.image->rgb.empty();
  if (has_image && uploaded_ != environment.image) {
    gl::TextureOptions options;
    options.min_filter = options.mag_filter = GL_LINEAR;
    image_ = gl::Texture("environment", GL_RGB32F, environment.image->size_px, options);
    glTextureParameteri(image_.id(), GL_TEXTURE_WRAP_S, GL_REPEAT);
    glTextureSubImage2D(image_.id(), 0, 0, 0, environment.image->size_px.x, environment.image->size_px.y, GL_RGB,
                        GL_FLOAT, environment.image->rgb.data());
    uploaded_ = environment.image;
  }
  const DeviceEnvironment packed{glm::vec4(environment.zenith_radiance, environment.rotation),
                                 glm::vec4(environment.horizon_radiance, environment.strength),
                                 glm::vec4(environment.ground_radiance, has_image ? 1.0f : 0.0f),
                                 glm::vec4(background.value_or(glm::vec3(0.0f)), background ? 1.0f : 0.0f)};
  block_.upload(std::span<const DeviceEnvironment>(&packed, 1));
}

void EnvironmentBlock::bind() const {
  block_.bind_uniform(BINDING_ENVIRONMENT);
  glBindTextureUnit(UNIT_ENVIRONMENT, image_.id());
}

ComposePass::ComposePass(gl::ShaderLibrary& shaders)
    : surfaces_([&shaders](const gl::Defines& defines) {
        return shaders.raster("passes/full_screen_camera.vert", "passes/compose.frag", defines);
      }),
      background_([&shaders](const gl::Defines& defines) {
        return shaders.raster("passes/full_screen_camera.vert", "passes/background.frag", defines);
      }) {}

void ComposePass::resize(const gl::Texture& depth) {
  if (picture_.image && picture_.image.size_px() == depth.size_px() && depth_id_ == depth.id()) return;
  picture_ = {gl::Texture("picture", GL_RGBA32F, depth.size_px()), 0};
  framebuffer_ = gl::Framebuffer("picture", {&picture_.image}, &depth);
  depth_id_ = depth.id();
}

const Picture& ComposePass::run(const DeviceScene& scene, const GBuffer& g_buffer, const ShadowMaps& shadows,
                                const IndirectMap& indirect, const GatherPass& gathered, const MapViewPass& map_view,
                                const Settings& settings, bool accumulate) {
  g_buffer.bind();
  shadows.bind();
  indirect.image.bind(UNIT_IMAGE_B);
  gathered.occlusion_distance().bind(UNIT_IMAGE_C);
  gathered.guide().bind(UNIT_GUIDE);
  map_view.image().bind(UNIT_VIEW_MAP);
  gl::Defines defines = is_of_light(settings.view) ? gl::joined(scene.light_defines(), scene.brdf_defines())
                                                   : gl::Defines{"AUXILIARY_VIEWS 1"};
  if (settings.denoise && is_of_light(settings.view)) defines.emplace_back("JOINT_UPSCALE 1");
  return draw(defines, scene.environment_defines(), settings, accumulate);
}

const Picture& ComposePass::run_over(const BehindClear& behind, const DeviceScene& scene, const GBuffer& g_buffer,
                                     const ShadowMaps& shadows, const IndirectMap& indirect, const GatherPass& gathered,
                                     const Settings& settings, bool accumulate) {
  const gl::Defines over{"OVER_BEHIND 1", "CLEAR_RECEIVER 1"};
  g_buffer.bind();
  shadows.bind();
  indirect.image.bind(UNIT_IMAGE_B);
  gathered.guide().bind(UNIT_GUIDE);
  behind.picture.image.bind(UNIT_BEHIND);
  behind.layers.bind(UNIT_CLEAR_LAYERS);
  gl::Defines defines = is_of_light(settings.view)
                            ? gl::joined(gl::joined(scene.light_defines(), scene.brdf_defines()), over)
                            : gl::Defines{"AUXILIARY_VIEWS 1"};
  if (settings.denoise && is_of_light(settings.view)) defines.emplace_back("JOINT_UPSCALE 1");
  return draw(defines, over, settings, accumulate);
}

const Picture& ComposePass::run(const DeviceScene& scene, const GBuffer& g_buffer, const TracedLight& direct,
                                const ReconstructedMap& indirect, const PixelLists* lists, std::uint32_t frame_number,
                                const Settings& settings, bool accumulate) {
  g_buffer.bind();
  direct.light_texels.bind(UNIT_PUNCTUAL_LIGHT);
  direct.visible_texels.bind(UNIT_PUNCTUAL_VISIBLE);
  indirect.image->bind(UNIT_IMAGE_B);
  indirect.guide->bind(UNIT_GUIDE);
  gl::Defines defines =
      gl::joined(gl::joined(scene.brdf_defines(), scene.smooth_defines()), {direct.define(), "JOINT_UPSCALE 1"});
  if (lists) {
    defines.emplace_back("LIST_PIXELS 1");
    lists->bind();
    Variant& variant = surfaces_.with(defines);
    variant.unmatched_share = lists->unmatched_share();
    variant.most_unmatched = lists->most_unmatched();
    variant.frame_number = frame_number;
  }
  return draw(defines, scene.environment_defines(), settings, accumulate);
}

const Picture& ComposePass::run_over(const BehindClear& behind, const DeviceScene& scene, const GBuffer& g_buffer,
                                     const TracedLight& direct, const PixelLists* lists, const Settings& settings,
                                     bool accumulate) {
  const gl::Defines over{"OVER_BEHIND 1"};
  g_buffer.bind();
  direct.light_texels.bind(UNIT_PUNCTUAL_LIGHT);
  direct.visible_texels.bind(UNIT_PUNCTUAL_VISIBLE);
  behind.picture.image.bind(UNIT_BEHIND);
  behind.layers.bind(UNIT_CLEAR_LAYERS);
  gl::Defines defines = gl::joined(gl::joined(scene.brdf_defines(), over), {direct.define(), "NO_MAP 1"});
  if (lists) {
    defines.emplace_back("LIST_PIXELS 1");
    if (scene.has_clear_volumes()) defines.emplace_back("REFRACTED 1");
    lists->bind();
  }
  return draw(defines, over, settings, accumulate);
}

const Picture& ComposePass::show(const DeviceScene& scene, const GBuffer& g_buffer, const gl::Texture& view_map,
                                 const Settings& settings, bool accumulate) {
  g_buffer.bind();
  view_map.bind(UNIT_VIEW_MAP);
  return draw({"AUXILIARY_VIEWS 1"}, scene.environment_defines(), settings, accumulate);
}

const Picture& ComposePass::draw(const gl::Defines& surfaces, const gl::Defines& background, const Settings& settings,
                                 bool accumulate) {
  if (!accumulate) picture_.accumulated = 0;
  framebuffer_.bind();
  if (picture_.accumulated > 0) {
    glEnable(GL_BLEND);
    glBlendFunc(GL_CONSTANT_ALPHA, GL_ONE_MINUS_CONSTANT_ALPHA);
    glBlendColor(0.0f, 0.0f, 0.0f, 1.0f / static_cast<float>(picture_.accumulated + 1));
  }
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_FALSE);  // the G-buffer's depth is read by the shaders, too
  draw_surfaces(surfaces, settings);
  draw_background(background, settings);
  glDepthMask(GL_TRUE);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  ++picture_.accumulated;
  return picture_;
}

// The triangle lies at infinity, at depth 0: surfaces are where something nearer is stored.
void ComposePass::draw_surfaces(const gl::Defines& defines, const Settings& settings) {
  Variant& variant = surfaces_.with(defines);
  variant.view = static_cast<int>(settings.view);
  variant.program->use();
  glDepthFunc(GL_LESS);
  full_screen_.draw_full_screen();
}

void ComposePass::draw_background(const gl::Defines& defines, const Settings& settings) {
  Background& background = background_.with(defines);
  background.shown = settings.view == ViewKind::kFinal || settings.view == ViewKind::kDirect ? 1 : 0;
  background.tinted = is_of_light(settings.view) ? 1 : 0;
  background.program->use();
  glDepthFunc(GL_EQUAL);
  full_screen_.draw_full_screen();
}

DisplayPass::DisplayPass(gl::ShaderLibrary& shaders)
    : exposure_program_(shaders.compute("passes/exposure.comp")),
      display_program_(shaders.raster("passes/display.vert", "passes/display.frag")),
      exposure_size_px_(exposure_program_, "size_px"),
      smoothing_(exposure_program_, "smoothing"),
      mapping_(display_program_, "mapping"),
      neutral_curve_(display_program_, "neutral_curve"),
      fixed_exposure_(display_program_, "fixed_exposure"),
      exposure_("exposure", sizeof(DeviceExposure), gl::BufferUse::kHostVisible) {
  exposure_.clear();
  exposure_texel_.attach(exposure_);
}

void DisplayPass::measure_exposure(const Picture& picture, float smoothing) {
  picture.image.bind(UNIT_IMAGE_A);
  exposure_.bind_storage(BINDING_EXPOSURE);
  exposure_size_px_ = picture.image.size_px();
  smoothing_ = smoothing;
  exposure_program_->dispatch(1u, 1u);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
}

void DisplayPass::run(const Picture& picture, const Settings& settings) {
  resize(picture.image.size_px());
  picture.image.bind(UNIT_IMAGE_A);
  exposure_texel_.bind(UNIT_IMAGE_B);
  mapping_ = mapping_of(settings.view);
  neutral_curve_ = settings.tone_map == ToneMap::kNeutral ? 1 : 0;
  fixed_exposure_ = settings.exposure_ev ? std::exp2(*settings.exposure_ev) : 0.0f;
  framebuffer_.bind();
  display_program_->use();
  full_screen_.draw_full_screen();
}

void DisplayPass::resize(glm::ivec2 size_px) {
  if (display_ && display_.size_px() == size_px) return;
  display_ = gl::Texture("display", GL_RGBA8, size_px);
  framebuffer_ = gl::Framebuffer("display", {&display_}, nullptr);
}

std::vector<std::uint8_t> DisplayPass::read_rgbx() const {
  const glm::ivec2 size_px = display_.size_px();
  std::vector<std::uint8_t> rgbx(static_cast<std::size_t>(size_px.x) * static_cast<std::size_t>(size_px.y) * 4);
  glGetTextureImage(display_.id(), 0, GL_RGBA, GL_UNSIGNED_BYTE, static_cast<GLsizei>(rgbx.size()), rgbx.data());
  return rgbx;
}

float DisplayPass::measured_exposure_ev() const {
  DeviceExposure values;
  std::memcpy(&values, exposure_.host(), sizeof values);
  return values.exposure_ev;
}

}  // namespace lightwell
