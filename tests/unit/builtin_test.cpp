// The built-in scenes are sound: finite, closed the right way round, and as large as they say.
#include "renderer/scene/builtin.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "renderer/scene/pose.h"

namespace lightwell {
namespace {

class BuiltinScene : public testing::TestWithParam<std::string> {
 protected:
  const Scene scene_ = builtin_scene(GetParam()).value();
};

INSTANTIATE_TEST_SUITE_P(All, BuiltinScene, testing::ValuesIn(builtin_scene_names()),
                         [](const auto& tested) { return tested.param; });

TEST_P(BuiltinScene, EveryPrimitiveIsSound) {
  for (const auto& mesh : scene_.meshes)
    for (const Primitive& primitive : mesh->primitives) {
      SCOPED_TRACE(mesh->name);
      const std::size_t count = primitive.positions.size();
      ASSERT_EQ(primitive.normals.size(), count);
      ASSERT_EQ(primitive.tangents.size(), count);
      ASSERT_GT(primitive.indices.size(), 0u);
      ASSERT_EQ(primitive.indices.size() % 3, 0u);
      ASSERT_GE(primitive.material, 0);
      ASSERT_LT(static_cast<std::size_t>(primitive.material), scene_.materials.size());
      glm::vec3 low = primitive.positions[0], high = low;
      for (std::size_t i = 0; i < count; ++i) {
        low = glm::min(low, primitive.positions[i]);
        high = glm::max(high, primitive.positions[i]);
        ASSERT_NEAR(glm::length(primitive.normals[i]), 1.0f, 1e-4f);
        ASSERT_NEAR(glm::length(glm::vec3(primitive.tangents[i])), 1.0f, 1e-4f);
        ASSERT_NEAR(glm::dot(glm::vec3(primitive.tangents[i]), primitive.normals[i]), 0.0f, 1e-3f);
        ASSERT_EQ(std::abs(primitive.tangents[i].w), 1.0f);
      }
      EXPECT_EQ(low, primitive.bounds_min);
      EXPECT_EQ(high, primitive.bounds_max);
      for (const std::uint32_t i : primitive.indices) ASSERT_LT(i, count);
    }
}

/// No sliver without area, and the shading normals are on the side that the winding calls the front.
TEST_P(BuiltinScene, TrianglesFaceAsTheirNormalsDo) {
  for (const auto& mesh : scene_.meshes)
    for (const Primitive& primitive : mesh->primitives) {
      SCOPED_TRACE(mesh->name);
      for (std::size_t i = 0; i < primitive.indices.size(); i += 3) {
        const auto at = [&](std::size_t corner) { return primitive.indices[i + corner]; };
        const glm::vec3 a = primitive.positions[at(0)];
        const glm::vec3 n = glm::cross(primitive.positions[at(1)] - a, primitive.positions[at(2)] - a);
        ASSERT_GT(glm::length(n), 1e-9f) << "triangle " << i / 3;
        for (std::size_t corner = 0; corner < 3; ++corner)
          ASSERT_GT(glm::dot(glm::normalize(n), primitive.normals[at(corner)]), 0.0f) << "triangle " << i / 3;
      }
    }
}

TEST_P(BuiltinScene, HasACameraAndLightThatFloat16Holds) {
  EXPECT_FALSE(scene_.cameras.empty());
  const bool has_sky = scene_.environment.zenith_radiance != glm::vec3(0.0f);
  EXPECT_TRUE(!scene_.lights.empty() || has_sky);
  for (const Light& light : scene_.lights) EXPECT_LT(light.intensity, 20000.0f);
  for (const Material& material : scene_.materials) EXPECT_LT(material.emissive_strength, 20000.0f);
}

TEST_P(BuiltinScene, EveryPoseIsFiniteAndRepeats) {
  const double duration_s = animation_duration_s(scene_);
  for (const double time_s : {0.0, 1.3, 0.77 * duration_s}) {
    const Pose pose = pose_at(scene_, time_s), again = pose_at(scene_, time_s + duration_s);
    ASSERT_TRUE(std::isfinite(glm::length(pose.bounds_min)) && std::isfinite(glm::length(pose.bounds_max)));
    for (std::size_t i = 0; i < pose.instances.size(); ++i)
      for (int c = 0; c < 4; ++c)
        ASSERT_LT(glm::length(pose.instances[i].world_from_object[c] - again.instances[i].world_from_object[c]), 1e-2f);
    for (std::size_t i = 0; i < pose.lights.size(); ++i)
      ASSERT_LT(glm::length(pose.lights[i].direction_ws - again.lights[i].direction_ws), 1e-3f);
  }
}

TEST(Builtin, UnknownNamesAreNotFoundAndNameWhatThereIs) {
  const Result<Scene> result = builtin_scene("teapot");
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().kind, ErrorKind::kNotFound);
  EXPECT_NE(result.error().message().find("cornell"), std::string::npos);
}

TEST(Builtin, CornellIsSmallAndStill) {
  const Scene scene = builtin_scene("cornell").value();
  EXPECT_GE(count_triangles(scene), 32u);
  EXPECT_LE(count_triangles(scene), 36u);
  EXPECT_EQ(animation_duration_s(scene), 0.0);
  const Pose pose = pose_at(scene, 0);
  EXPECT_NEAR(pose.bounds_max.y - pose.bounds_min.y, 2.0f, 0.01f);
}

/// The scenes of the thesis' figure 6.5: scene, light and camera move, and come back.
class MovingScene : public testing::TestWithParam<std::pair<std::string, std::uint64_t>> {};

INSTANTIATE_TEST_SUITE_P(Thesis, MovingScene,
                         testing::Values(std::pair{"helicopters", 1522u}, std::pair{"venus", 3284u}),
                         [](const auto& tested) { return tested.param.first; });

float difference(const glm::mat4& a, const glm::mat4& b) {
  float largest = 0.0f;
  for (int c = 0; c < 4; ++c) largest = std::max(largest, glm::length(a[c] - b[c]));
  return largest;
}

TEST_P(MovingScene, HasItsTriangles) {
  EXPECT_EQ(count_triangles(builtin_scene(GetParam().first).value()), GetParam().second);
}

TEST_P(MovingScene, SceneLightAndCameraMoveAndComeBack) {
  const Scene scene = builtin_scene(GetParam().first).value();
  const double duration_s = animation_duration_s(scene);
  EXPECT_NEAR(duration_s, 12.0, 1e-6);
  const Pose first = pose_at(scene, 0.0), later = pose_at(scene, 1.0);
  const Pose before = pose_at(scene, duration_s - 1e-4), again = pose_at(scene, duration_s);

  EXPECT_GT(difference(first.cameras[0].world_from_view, later.cameras[0].world_from_view), 0.05f);
  EXPECT_LT(difference(first.cameras[0].world_from_view, before.cameras[0].world_from_view), 0.01f);
  EXPECT_LT(difference(first.cameras[0].world_from_view, again.cameras[0].world_from_view), 1e-4f);

  ASSERT_EQ(first.lights.size(), 2u);
  for (std::size_t i = 0; i < first.lights.size(); ++i) {
    EXPECT_GT(glm::distance(first.lights[i].direction_ws, later.lights[i].direction_ws), 0.01f);
    EXPECT_LT(glm::distance(first.lights[i].direction_ws, before.lights[i].direction_ws), 0.01f);
    EXPECT_LT(glm::distance(first.lights[i].position_ws, before.lights[i].position_ws), 0.01f);
  }

  int moving = 0;
  for (std::size_t i = 0; i < first.instances.size(); ++i) {
    if (difference(first.instances[i].world_from_object, later.instances[i].world_from_object) > 0.1f) ++moving;
    EXPECT_LT(difference(first.instances[i].world_from_object, before.instances[i].world_from_object), 0.02f);
  }
  EXPECT_GE(moving, 10);  // two helicopters of five parts each
}

/// From one frame to the next nothing jumps: 1/60 s never moves a helicopter by more than half a metre.
TEST_P(MovingScene, NothingJumps) {
  const Scene scene = builtin_scene(GetParam().first).value();
  Pose before = pose_at(scene, 0.0);
  for (int frame = 1; frame <= 12 * 60; ++frame) {
    Pose now = pose_at(scene, frame / 60.0);
    for (std::size_t i = 0; i < now.instances.size(); ++i)
      ASSERT_LT(glm::distance(now.instances[i].world_from_object[3], before.instances[i].world_from_object[3]), 0.5f);
    for (std::size_t i = 0; i < now.lights.size(); ++i)
      ASSERT_LT(glm::distance(now.lights[i].direction_ws, before.lights[i].direction_ws), 0.05f);
    ASSERT_LT(difference(now.cameras[0].world_from_view, before.cameras[0].world_from_view), 0.5f);
    before = std::move(now);
  }
}

/// All triangles of a pose in the world, for the few rays of a test.
std::vector<std::array<glm::vec3, 3>> world_triangles(const Pose& pose) {
  std::vector<std::array<glm::vec3, 3>> triangles;
  for (const Instance& instance : pose.instances)
    for (std::size_t i = 0; i < instance.primitive->indices.size(); i += 3) {
      const auto corner = [&](std::size_t k) {
        const glm::vec3& p = instance.primitive->positions[instance.primitive->indices[i + k]];
        return glm::vec3(instance.world_from_object * glm::vec4(p, 1.0f));
      };
      triangles.push_back({corner(0), corner(1), corner(2)});
    }
  return triangles;
}

struct NearestHit {
  float distance = std::numeric_limits<float>::max();
  bool front = false;
};

NearestHit nearest_hit(const std::vector<std::array<glm::vec3, 3>>& triangles, const glm::vec3& origin,
                       const glm::vec3& direction) {
  NearestHit nearest;
  for (const auto& [a, b, c] : triangles) {
    const glm::vec3 ab = b - a, ac = c - a, p = glm::cross(direction, ac);
    const float determinant = glm::dot(ab, p);
    if (determinant == 0.0f) continue;
    const glm::vec3 from_a = origin - a, q = glm::cross(from_a, ab);
    const float u = glm::dot(from_a, p) / determinant, v = glm::dot(direction, q) / determinant;
    const float distance = glm::dot(ac, q) / determinant;
    if (u < 0.0f || v < 0.0f || u + v > 1.0f || distance <= 0.0f || distance >= nearest.distance) continue;
    nearest = {distance, determinant > 0.0f};
  }
  return nearest;
}

/// From the hall no ray sees a wall from behind, and the only ways out are the well's opening and the aisle's slit.
TEST(Builtin, TheAtriumIsTight) {
  const std::vector<std::array<glm::vec3, 3>> triangles =
      world_triangles(pose_at(builtin_scene("atrium").value(), 7.0));
  std::mt19937 random(5);
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  for (int i = 0; i < 3000; ++i) {
    const glm::vec3 origin(-2.4f + 4.6f * uniform(random), 1.1f + 2.2f * uniform(random),
                           3.2f + 3.8f * uniform(random));
    const float y = 2.0f * uniform(random) - 1.0f, around = 6.2831853f * uniform(random),
                flat = std::sqrt(1.0f - y * y);
    const glm::vec3 direction(flat * std::cos(around), y, flat * std::sin(around));
    const NearestHit hit = nearest_hit(triangles, origin, direction);
    SCOPED_TRACE(testing::Message() << "from " << origin.x << ' ' << origin.y << ' ' << origin.z << " along "
                                    << direction.x << ' ' << direction.y << ' ' << direction.z);
    if (hit.distance < 100.0f) {
      ASSERT_TRUE(hit.front);
      continue;
    }
    ASSERT_GT(direction.y, 0.0f);
    const auto crossing = [&](float height) { return origin + direction * ((height - origin.y) / direction.y); };
    const glm::vec3 slit = crossing(4.6f), opening = crossing(15.0f);
    const bool through_slit = slit.x < -4.7f && slit.x > -5.21f && slit.z > 0.0f;
    const bool through_opening = std::abs(opening.x) < 2.61f && opening.z > -5.31f && opening.z < -0.59f;
    ASSERT_TRUE(through_slit || through_opening);
  }
}

TEST(DefaultLight, IsAddedOnlyWhereNothingShines) {
  Scene dark;
  EXPECT_TRUE(add_default_light(dark));
  const Pose pose = pose_at(dark, 0);
  ASSERT_EQ(pose.lights.size(), 1u);
  const PlacedLight& sun = pose.lights[0];
  const Environment& sky = dark.environment;
  const float sun_lux = sun.light.intensity * -sun.direction_ws.y;
  const float sky_lux =
      3.14159265f * glm::dot(0.5f * (sky.zenith_radiance + sky.horizon_radiance), glm::vec3(1.0f / 3));
  EXPECT_NEAR(sun_lux / sky_lux, 3.0f, 0.5f);
  EXPECT_FALSE(add_default_light(dark));

  Scene glowing;
  glowing.materials.emplace_back();
  glowing.materials[0].emissive_factor = glm::vec3(0.1f);
  EXPECT_TRUE(add_default_light(glowing));
  EXPECT_TRUE(glowing.lights.empty());
  EXPECT_LT(glowing.environment.strength, 0.5f);
  Scene under_sky;
  under_sky.environment.image = std::make_shared<ImageHdr>();
  EXPECT_FALSE(add_default_light(under_sky));
}

}  // namespace
}  // namespace lightwell
