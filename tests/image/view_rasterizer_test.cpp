// What cameras and shadow maps see, drawn by the processor and by the device: the same pictures, save where an edge's
// pixel falls to the one side or to the other.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "renderer/passes/view_rays.h"
#include "renderer/scene/bounds.h"
#include "renderer/scene/builtin.h"
#include "renderer/scene/builtin/scene_builder.h"
#include "renderer/scene/builtin/shapes.h"
#include "renderer/tracing/embree/embree_tracer.h"
#include "tests/image/test_scenes.h"

namespace lightwell::testing {
namespace {

struct Shot {
  Scene scene;
  PlacedCamera camera;
  Settings settings;
  double time_s = 0.0;
};

constexpr glm::ivec2 kSize_px{96, 96};

/// Each the second of two frames of a view, so that something may have moved since the first. Adds up in `by_processor`
/// the views that the processor has drawn.
std::vector<Pixels> pictures_of(const std::vector<Shot>& shots, SeenBy seen_by, std::uint32_t& by_processor) {
  RendererOptions options;
  options.device.request = "software";
  options.make_native_tracer = [] { return make_embree_tracer(); };
  options.seen_by = seen_by;
  options.compile_ahead = false;
  Renderer renderer(options);
  std::vector<Pixels> pictures;
  for (const Shot& shot : shots) {
    const std::unique_ptr<RenderView> view = renderer.make_view();
    FrameRequest request;
    request.camera = shot.camera;
    request.size_px = kSize_px;
    request.settings = shot.settings;
    request.want_linear = true;
    Result<Frame> frame = renderer.render(shot.scene, request, *view);  // what may move from
    if (frame) by_processor += frame->views_by_processor;
    request.time_s = shot.time_s;
    frame = renderer.render(shot.scene, request, *view);
    if (frame) by_processor += frame->views_by_processor;
    EXPECT_TRUE(frame.ok()) << (frame.ok() ? "" : frame.error().message());
    pictures.push_back({kSize_px, frame ? std::move(frame->linear_rgb) : std::vector<float>()});
  }
  for (const std::string& message : renderer.context().take_debug_messages()) ADD_FAILURE() << "GL: " << message;
  return pictures;
}

struct Difference {
  double of_most;  // mean of |a - b| / (b + 0.1 of b's mean) over the pixels, without the most different 3 %
  double of_mean;  // of the means, relative
};

Difference difference(const Pixels& a, const Pixels& b) {
  const auto count = static_cast<std::size_t>(b.size_px.x * b.size_px.y);
  double mean_a = 0.0, mean_b = 0.0;
  for (std::size_t i = 0; i < 3 * count; ++i) {
    mean_a += std::abs(static_cast<double>(a.rgb[i])) / static_cast<double>(3 * count);
    mean_b += std::abs(static_cast<double>(b.rgb[i])) / static_cast<double>(3 * count);
  }
  std::vector<double> of_pixels(count);
  for (std::size_t i = 0; i < 3 * count; ++i)
    of_pixels[i / 3] += std::abs(static_cast<double>(a.rgb[i]) - static_cast<double>(b.rgb[i])) /
                        (std::abs(static_cast<double>(b.rgb[i])) + 0.1 * mean_b + 1e-9) / 3.0;
  std::sort(of_pixels.begin(), of_pixels.end());
  of_pixels.resize(count - count * 3 / 100);
  double sum = 0.0;
  for (const double of_pixel : of_pixels) sum += of_pixel;
  return {sum / static_cast<double>(of_pixels.size()), std::abs(mean_a - mean_b) / (mean_b + 1e-9)};
}

Settings shown(ViewKind view, Method method = Method::kThesis) {
  Settings settings;
  settings.view = view;
  settings.method = method;
  settings.indirect_size = 32;
  return settings;
}

constexpr double kOfSurfaces = 2e-4, kOfLight = 3e-3, kOfMeans = 1e-2;

/// The same by the processor and by the device, and by the processor in truth.
void expect_alike(const std::vector<Shot>& shots, const std::string& name, bool lights) {
  std::uint32_t by_processor = 0, by_device = 0;
  const std::vector<Pixels> of_processor = pictures_of(shots, SeenBy::kProcessor, by_processor);
  const std::vector<Pixels> of_device = pictures_of(shots, SeenBy::kDevice, by_device);
  EXPECT_GE(by_processor, 2 * shots.size() + (lights ? 2 : 0));  // of the camera for each, and of lights
  EXPECT_EQ(by_device, 0u);
  for (std::size_t i = 0; i < shots.size(); ++i) {
    const Settings& settings = shots[i].settings;
    SCOPED_TRACE(name + ", " + std::string(name_of(settings.view)) + " of " + std::string(name_of(settings.method)));
    const Difference found = difference(of_processor[i], of_device[i]);
    const bool of_light = settings.view == ViewKind::kFinal || settings.view == ViewKind::kDirect;
    std::printf("%s, %s of %s: %.2e, means %.2e\n", name.c_str(), std::string(name_of(settings.view)).c_str(),
                std::string(name_of(settings.method)).c_str(), found.of_most, found.of_mean);
    EXPECT_LT(found.of_most, of_light ? kOfLight : kOfSurfaces);
    EXPECT_LT(found.of_mean, kOfMeans);
  }
}

// Textures with their levels, normal maps, skins, rigid motion, backs that the camera does not see.
TEST(ViewRasterizer, BuiltInScenesLookAsTheDeviceDrawsThem) {
  for (const std::string& name : builtin_scene_names()) {
    const Scene scene = *builtin_scene(name);
    const PlacedCamera camera = pose_at(scene, 0.0).cameras.front();
    std::vector<Shot> shots;
    for (const ViewKind view : {ViewKind::kAlbedo, ViewKind::kNormal, ViewKind::kDepth, ViewKind::kDirect})
      shots.push_back({scene, camera, shown(view), 1.3});
    for (const ViewKind view : {ViewKind::kMotion, ViewKind::kFinal})
      shots.push_back({scene, camera, shown(view, Method::kRealtime), 0.1});
    expect_alike(shots, name, true);
  }
}

Scene scene_of_transforms() {
  builtin::SceneBuilder builder("transforms");
  const int grey = builder.material("grey", {0.6f, 0.6f, 0.6f});
  const int red = builder.material("red", {0.7f, 0.2f, 0.1f}, 0.3f);
  const int leaf = builder.material("leaf", {0.1f, 0.6f, 0.1f});
  builder.material(leaf).double_sided = true;
  builtin::MeshBuilder ground, ball = builtin::sphere(0.5f, 24, 12), half;
  ground.quad({-4, 0, 4}, {4, 0, 4}, {4, 0, -4}, {-4, 0, -4});
  half.quad({-0.5f, 0, 0}, {0.5f, 0, 0}, {0.5f, 1, 0}, {-0.5f, 1, 0});
  builder.mesh_node("ground", {{ground, grey}});
  const int balls = builder.mesh("balls", {{ball, red}});
  builder.mesh_node("stretched", balls, {{-1.5f, 0.5f, 0}, glm::quat(1, 0, 0, 0), {1.8f, 0.8f, 0.6f}});
  builder.mesh_node("mirrored", balls, {{0.2f, 0.6f, 0.4f}, glm::quat(1, 0, 0, 0), {-1.0f, 1.2f, 1.0f}});
  // Of a single-sided leaf the camera sees what lies behind its back.
  const glm::quat turned = glm::angleAxis(3.14159265f, glm::vec3(0, 1, 0));
  builder.mesh_node("leaf, front", {{half, leaf}}, {{1.6f, 0, 0.6f}, glm::quat(1, 0, 0, 0), {1, 1, 1}});
  builder.mesh_node("leaf, back", {{half, leaf}}, {{1.6f, 0, -1.0f}, turned, {1, 1, 1}});
  builder.mesh_node("back", {{half, red}}, {{0.2f, 0, 1.4f}, turned, {1.4f, 1.4f, 1}});
  builder.mesh_node("mirrored front", {{half, red}}, {{-1.2f, 0, 1.4f}, glm::quat(1, 0, 0, 0), {-1, 1, 1}});
  builder.environment().zenith_radiance = builder.environment().horizon_radiance = glm::vec3(0.2f);
  return std::move(builder).finish();
}

void add_light(Scene& scene, LightKind kind, glm::vec3 position, glm::vec3 direction) {
  Light light;
  light.kind = kind;
  light.intensity = kind == LightKind::kDirectional ? 3.0f : 20.0f;
  Node node;
  node.matrix = glm::inverse(glm::lookAt(position, position + direction, glm::vec3(0, 0, 1)));
  node.light = static_cast<int>(scene.lights.size());
  scene.lights.push_back(light);
  scene.roots.push_back(static_cast<int>(scene.nodes.size()));
  scene.nodes.push_back(node);
}

TEST(ViewRasterizer, TransformsBacksCamerasAndLightsOfAllKinds) {
  const PlacedCamera cameras[] = {look_at({0, 2, 5}, {0, 0.5f, 0}, 0.8f), look_parallel({1, 3, 5}, {0, 0.5f, 0}, 5.0f)};
  for (const LightKind kind : {LightKind::kDirectional, LightKind::kSpot, LightKind::kPoint}) {
    Scene scene = scene_of_transforms();
    add_light(scene, kind, {0.5f, 3.0f, 1.5f}, {-0.3f, -1.0f, -0.4f});
    std::vector<Shot> shots;
    for (const PlacedCamera& camera : cameras)
      for (const ViewKind view : {ViewKind::kAlbedo, ViewKind::kNormal, ViewKind::kDepth, ViewKind::kDirect})
        shots.push_back({scene, camera, shown(view), 0.0});
    expect_alike(shots, "light of kind " + std::to_string(static_cast<int>(kind)), true);
  }
}

// A quad whose upper edge comes nearer by a metre a second.
Scene morphing_quad() {
  SceneMaker maker;
  maker.quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, maker.material(lambert(glm::vec3(0.5f))));
  maker.point({0, 0, 5}, 50.0f);
  Scene scene = maker.take();
  Mesh mesh = *scene.meshes[0];
  mesh.primitives[0].morph_targets = {{{{0, 0, 0}, {0, 0, 0}, {0, 0, 1}, {0, 0, 1}}, {}, {}}};
  fill_bounds(mesh.primitives[0]);
  mesh.weights = {0.0f};
  scene.meshes[0] = std::make_shared<const Mesh>(mesh);
  AnimationChannel channel;
  channel.node = 0;
  channel.property = AnimatedProperty::kWeights;
  channel.times_s = {0.0f, 1.0f};
  channel.values = {0.0f, 1.0f};
  channel.width = 1;
  scene.animations.push_back({"morph", {channel}, {}, 1.0f});
  return scene;
}

TEST(ViewRasterizer, MotionWithinAMesh) {
  std::vector<Shot> shots;
  for (const ViewKind view : {ViewKind::kMotion, ViewKind::kNormal, ViewKind::kFinal})
    shots.push_back({morphing_quad(), look_at({0, 0, 6}, {0, 0, 0}, 0.2f), shown(view, Method::kRealtime), 0.25});
  expect_alike(shots, "morphing quad", true);
  std::uint32_t by_processor = 0;
  const Pixels motion = pictures_of(shots, SeenBy::kProcessor, by_processor)[0];
  // It does move.
  EXPECT_GT(motion.mean().g + motion.mean().b + motion.mean().r, 0.01f);
}

// Seen from outside, a room whose walls face inwards is open; what glows within is seen through them.
TEST(ViewRasterizer, BacksOfSingleSidedWallsAreNotSeen) {
  for (const bool double_sided : {false, true}) {
    SceneMaker maker;
    Material wall = lambert(glm::vec3(0.0f), glm::vec3(double_sided ? 2.0f : 0.0f));
    wall.double_sided = double_sided;
    for (int i = 0; i < 3; ++i)  // one behind the other, all turned away
      maker.quad({2, -2, 1.0f + static_cast<float>(i)}, {-4, 0, 0}, {0, 4, 0}, maker.material(wall));
    maker.quad({-2, -2, -1}, {4, 0, 0}, {0, 4, 0}, maker.material(lambert(glm::vec3(0.0f), glm::vec3(5.0f))));
    std::uint32_t by_processor = 0;
    const std::vector<Pixels> pictures =
        pictures_of({{maker.take(), look_at({0, 0, 6}, {0, 0, 0}, 0.3f), shown(ViewKind::kDirect)}}, SeenBy::kProcessor,
                    by_processor);
    EXPECT_EQ(by_processor, 2u);
    EXPECT_NEAR(pictures[0].center().g, double_sided ? 2.0f : 5.0f, 1e-3f);
    EXPECT_NEAR(pictures[0].mean().g, double_sided ? 2.0f : 5.0f, 1e-3f);
  }
}

// What hides only a part of what is behind it is the device's, whatever is asked for.
TEST(ViewRasterizer, MasksBlendsAndClearSurfacesAreTheDevices) {
  for (const int kind : {0, 1, 2}) {
    Scene scene = scene_of_transforms();
    add_light(scene, LightKind::kDirectional, {0, 3, 0}, {-0.3f, -1.0f, -0.4f});
    Material& material = scene.materials[1];
    if (kind == 0) material.alpha_mode = AlphaMode::kMask;
    if (kind == 1) material.alpha_mode = AlphaMode::kBlend;
    if (kind == 2) material.transmission_factor = 1.0f, material.roughness_factor = 0.0f;
    material.base_color_factor.a = kind == 1 ? 0.5f : 1.0f;
    const std::vector<Shot> shots = {{scene, look_at({0, 2, 5}, {0, 0.5f, 0}), shown(ViewKind::kFinal)}};
    std::uint32_t by_processor = 0, by_device = 0;
    const std::vector<Pixels> of_processor = pictures_of(shots, SeenBy::kProcessor, by_processor);
    const std::vector<Pixels> of_device = pictures_of(shots, SeenBy::kDevice, by_device);
    EXPECT_EQ(by_processor, 0u);
    EXPECT_EQ(of_processor[0].rgb, of_device[0].rgb);
  }
}

TEST(ViewRasterizer, ManyTrianglesAreTheProcessorsAndFewTheDevices) {
  for (const bool many : {false, true}) {
    builtin::SceneBuilder builder("ball");
    const int grey = builder.material("grey", {0.6f, 0.6f, 0.6f});
    const builtin::MeshBuilder ball = many ? builtin::sphere(1.0f, 256, 128) : builtin::sphere(1.0f, 32, 16);
    builder.mesh_node("ball", {{ball, grey}});
    Scene scene = std::move(builder).finish();
    add_light(scene, LightKind::kDirectional, {0, 3, 0}, {-0.3f, -1.0f, -0.4f});
    for (const Method method : {Method::kThesis, Method::kRealtime}) {
      Settings settings = shown(ViewKind::kDirect, method);
      settings.shadow_size = 128;
      std::uint32_t by_processor = 0;
      pictures_of({{scene, look_at({0, 1, 4}, {0, 0, 0}), settings}}, SeenBy::kQuicker, by_processor);
      EXPECT_EQ(by_processor, !many ? 0u : method == Method::kThesis ? 4u : 2u);  // shadow maps are the thesis'
    }
  }
}

}  // namespace
}  // namespace lightwell::testing
