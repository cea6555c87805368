// Loads every .glb and .gltf below the folder that the environment variable LIGHTWELL_ASSETS names; without it, none.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iostream>

#include "renderer/scene/gltf/load_gltf.h"
#include "renderer/scene/tangents.h"

namespace lightwell {
namespace {

std::vector<std::filesystem::path> gltf_files(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.path().extension() == ".glb" || entry.path().extension() == ".gltf") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

bool is_unit(const glm::vec3& v) {
  return std::abs(glm::length(v) - 1.0f) < 1e-4f;
}

/// What Primitive promises.
void expect_sound(const Primitive& primitive) {
  const std::size_t count = primitive.positions.size();
  ASSERT_EQ(primitive.normals.size(), count);
  ASSERT_EQ(primitive.tangents.size(), count);
  EXPECT_TRUE(primitive.uv0.empty() || primitive.uv0.size() == count);
  EXPECT_TRUE(primitive.uv1.empty() || primitive.uv1.size() == count);
  EXPECT_TRUE(primitive.colors.empty() || primitive.colors.size() == count);
  EXPECT_EQ(primitive.joints.size(), primitive.weights.size());
  EXPECT_EQ(primitive.indices.size() % 3, 0u);
  EXPECT_LT(*std::max_element(primitive.indices.begin(), primitive.indices.end()), count);
  EXPECT_TRUE(std::all_of(primitive.normals.begin(), primitive.normals.end(), is_unit));
  EXPECT_TRUE(std::all_of(primitive.tangents.begin(), primitive.tangents.end(),
                          [](const glm::vec4& t) { return is_unit(glm::vec3(t)) && std::abs(t.w) == 1.0f; }));
}

TEST(GltfAssets, AllLoad) {
  const char* folder = std::getenv("LIGHTWELL_ASSETS");
  if (!folder) GTEST_SKIP() << "LIGHTWELL_ASSETS names no folder";
  const std::vector<std::filesystem::path> files = gltf_files(folder);
  ASSERT_FALSE(files.empty());
  for (const std::filesystem::path& file : files) {
    SCOPED_TRACE(file);
    const auto begin = std::chrono::steady_clock::now();
    const Result<Scene> scene = load_gltf(file);
    const std::chrono::duration<double, std::milli> elapsed = std::chrono::steady_clock::now() - begin;
    if (!scene) {
      ADD_FAILURE() << scene.error().message();
      continue;
    }
    for (const auto& mesh : scene->meshes)
      for (const Primitive& primitive : mesh->primitives) expect_sound(primitive);
    std::cout << file.filename().string() << ": " << elapsed.count() << " ms, " << count_triangles(*scene)
              << " triangles, " << scene->nodes.size() << " nodes, " << scene->materials.size() << " materials, "
              << scene->images.size() << " images, " << scene->animations.size() << " animations\n";
    for (const std::string& warning : scene->warnings) std::cout << "  " << warning << '\n';
  }
}

/// Largest angle in degrees between the tangents that a file brings and those made here from its other attributes.
float largest_difference(const Primitive& primitive) {
  const TangentMesh made = make_tangents(primitive.positions, primitive.normals, primitive.uv0, primitive.indices);
  float least_cosine = 1.0f;
  for (std::size_t corner = 0; corner < primitive.indices.size(); ++corner) {
    const glm::vec4& given = primitive.tangents[primitive.indices[corner]];
    const glm::vec4& own = made.tangents[made.indices[corner]];
    EXPECT_EQ(given.w, own.w) << "corner " << corner;
    least_cosine = std::min(least_cosine, glm::dot(glm::vec3(given), glm::vec3(own)));
  }
  return glm::degrees(std::acos(least_cosine));
}

/// Blender made this file's tangents with the original implementation of MikkTSpace.
TEST(GltfAssets, TangentsAreThoseOfMikkTSpace) {
  const char* folder = std::getenv("LIGHTWELL_ASSETS");
  if (!folder) GTEST_SKIP() << "LIGHTWELL_ASSETS names no folder";
  for (const std::filesystem::path& file : gltf_files(folder)) {
    if (file.filename() != "NormalTangentMirrorTest.glb") continue;
    const Result<Scene> scene = load_gltf(file);
    ASSERT_TRUE(scene.ok());
    EXPECT_LT(largest_difference(scene->meshes[0]->primitives[0]), 0.1f);
  }
}

}  // namespace
}  // namespace lightwell
