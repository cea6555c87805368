// Scaling up and gathering on the processor gives the picture that the device's passes give. Those are asked for by a
// second bounce, which needs a record of every hit; the first bounce is then looked at alone.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <string>

#include "renderer/scene/builtin.h"
#include "tests/image/test_scenes.h"

namespace lightwell::testing {
namespace {

const glm::ivec2 kSizePx(96, 80);

struct View {
  std::string name;
  Scene scene;
  PlacedCamera camera;
};

Settings first_bounce(int patch, int groups, bool on_host) {
  Settings settings;
  settings.samples = 24;
  settings.indirect_size = 96;
  settings.patch = patch;
  settings.triangle_groups = groups;
  settings.view = ViewKind::kBounce;
  settings.view_index = 1;
  settings.bounces = on_host ? 1 : 2;
  return settings;
}

// The share of all light that is not where it should be.
double difference(const Pixels& a, const Pixels& b) {
  double sum = 0.0, of_all = 0.0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) {
    sum += std::abs(a.rgb[i] - b.rgb[i]);
    of_all += b.rgb[i];
  }
  return of_all > 0.0 ? sum / of_all : sum;
}

View builtin_view(const char* name) {
  View view{name, std::move(builtin_scene(name).value()), {}};
  const Pose pose = pose_at(view.scene, 1.0);
  view.camera = pose.cameras.empty() ? frame_camera(pose, 1.2f) : pose.cameras[0];
  return view;
}

// Metals, smooth and rough, round things, one mirrored, lights of all kinds, emission, unlit; a sky of three colours.
View everything() {
  SceneMaker maker;
  Material metal, glossy, unlit;
  metal.metallic_factor = 1.0f;
  metal.roughness_factor = 0.3f;
  metal.base_color_factor = glm::vec4(0.9f, 0.6f, 0.2f, 1.0f);
  glossy.metallic_factor = 0.2f;
  glossy.roughness_factor = 0.15f;
  glossy.base_color_factor = glm::vec4(0.2f, 0.4f, 0.9f, 1.0f);
  unlit.unlit = true;
  maker.quad({-4, -1, 4}, {8, 0, 0}, {0, 0, -8}, maker.material(lambert(glm::vec3(0.7f, 0.6f, 0.5f))));
  maker.quad({-4, -1, -3}, {8, 0, 0}, {0, 4, 0}, maker.material(glossy));
  maker.quad({-2.5f, -1, 1}, {0, 0, -2}, {0, 2, 0}, maker.material(unlit));
  maker.quad({2.5f, -1, -1}, {0, 0, 2}, {0, 2, 0},
             maker.material(lambert(glm::vec3(0.2f), glm::vec3(0.0f, 3.0f, 1.0f))));
  maker.sphere({-0.9f, 0, 0}, 0.9f, 24, false, maker.material(metal));
  maker.sphere({-1.1f, -0.2f, 0.4f}, 0.7f, 10, false, maker.material(glossy));
  maker.scene().nodes.back().local.scale.x = -1.0f;  // to the other side
  maker.directional({0.3f, -1.0f, -0.4f}, 2.0f);
  maker.point({0.0f, 1.5f, 1.5f}, 3.0f);
  maker.spot({-2.0f, 3.0f, 1.0f}, glm::normalize(glm::vec3(0.4f, -1.0f, -0.2f)), 9.0f, 0.5f);
  Scene scene = maker.take();
  scene.environment.zenith_radiance = glm::vec3(0.2f, 0.4f, 1.0f);
  scene.environment.horizon_radiance = glm::vec3(0.8f);
  scene.environment.ground_radiance = glm::vec3(0.3f, 0.2f, 0.1f);
  scene.environment.strength = 0.5f;
  return {"everything", std::move(scene), look_at({0.5f, 1.2f, 5.0f}, {0.0f, 0.0f, 0.0f}, 0.8f)};
}

// More triangles than the lanes have a hierarchy for, far smaller than pixels' distances; one side is mirrored.
View small_triangles() {
  SceneMaker maker;
  maker.quad({-4, -1, 4}, {8, 0, 0}, {0, 0, -8}, maker.material(lambert(glm::vec3(0.7f, 0.6f, 0.5f))));
  maker.sphere({-1.0f, 0, 0}, 0.95f, 300, false, maker.material(lambert(glm::vec3(0.2f, 0.5f, 0.8f))));
  maker.sphere({-1.0f, 0, 0.3f}, 0.95f, 300, false, maker.material(lambert(glm::vec3(0.8f, 0.3f, 0.2f))));
  maker.scene().nodes.back().local.scale.x = -1.0f;
  maker.directional({0.3f, -1.0f, -0.4f}, 2.0f);
  return {"small triangles", maker.take(), look_at({0.5f, 1.2f, 5.0f}, {0.0f, 0.0f, 0.0f}, 0.8f)};
}

void expect_same(const View& view, const char* what, Settings host, Settings device) {
  if (shared_renderer().tracer_name() != "embree") GTEST_SKIP() << "this build has no tracer on the processor";
  const Pixels by_host = render(view.scene, view.camera, host, kSizePx);
  const Pixels by_device = render(view.scene, view.camera, device, kSizePx);
  const double differs = difference(by_host, by_device);
  std::printf("%-12s %-24s %.2e of the light\n", view.name.c_str(), what, differs);
  EXPECT_LT(differs, 2e-4) << view.name << ", " << what;
  EXPECT_GT(by_host.mean().g, 0.0f);
}

TEST(HostGather, IsThePictureOfTheDevicesPasses) {
  for (const View& view : {everything(), builtin_view("helicopters"), builtin_view("venus"), builtin_view("cornell")})
    for (const int patch : {2, 8})
      expect_same(view, ("patches of " + std::to_string(patch)).c_str(), first_bounce(patch, 1, true),
                  first_bounce(patch, 1, false));
}

TEST(HostGather, KnowsGroupsAndLargePatches) {
  const View view = everything();
  expect_same(view, "3 groups", first_bounce(4, 3, true), first_bounce(4, 3, false));
  expect_same(view, "pixels in 2 groups", first_bounce(1, 2, true), first_bounce(1, 2, false));
  expect_same(view, "patches of 16", first_bounce(16, 1, true), first_bounce(16, 1, false));
}

TEST(HostGather, KnowsManySmallTriangles) {
  const View view = small_triangles();
  expect_same(view, "patches of 8", first_bounce(8, 1, true), first_bounce(8, 1, false));
  expect_same(view, "3 groups", first_bounce(4, 3, true), first_bounce(4, 3, false));
}

TEST(HostGather, KnowsTheMethodAsPrinted) {
  const View view = everything();
  Settings host = first_bounce(8, 1, true), device = first_bounce(8, 1, false);
  host.trace_missed = device.trace_missed = false;
  expect_same(view, "misses are not traced", host, device);
  host.similarity = device.similarity = Similarity::kLiteral;
  expect_same(view, "printed similarity", host, device);
}

// Of a small map, and in several batches.
TEST(HostGather, KnowsMapsAndBatches) {
  const View view = everything();
  Settings host = first_bounce(2, 1, true), device = first_bounce(2, 1, false);
  host.indirect_size = device.indirect_size = 40;
  expect_same(view, "map of 40", host, device);
  host.samples = device.samples = 600;
  expect_same(view, "600 directions", host, device);
  host.depth_threshold = device.depth_threshold = 0.0f;  // every pixel alone
  host.samples = device.samples = 8;
  expect_same(view, "nothing is similar", host, device);
}

TEST(HostGather, FiltersAndShowsDistancesAsThePassesDo) {
  const View view = everything();
  Settings host = first_bounce(4, 1, true), device = first_bounce(4, 1, false);
  host.denoise = device.denoise = true;
  expect_same(view, "denoised", host, device);
  host.view = device.view = ViewKind::kOcclusionDistance;
  expect_same(view, "occlusion distance", host, device);
}

TEST(HostGather, GivesTheSameBytesTwice) {
  const View view = everything();
  const Pixels first = render(view.scene, view.camera, first_bounce(4, 1, true), kSizePx);
  const Pixels second = render(view.scene, view.camera, first_bounce(4, 1, true), kSizePx);
  EXPECT_EQ(std::memcmp(first.rgb.data(), second.rgb.data(), first.rgb.size() * sizeof(float)), 0);
}

}  // namespace
}  // namespace lightwell::testing
