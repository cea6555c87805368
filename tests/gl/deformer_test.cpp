// Skins and morph targets made by the device, against those made by the processor.
#include "renderer/passes/deformer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "renderer/gl/device.h"
#include "renderer/passes/bindings.glsl"
#include "renderer/passes/device_types.h"

namespace lightwell {
namespace {

// Normals at rest have 16 bits, and those of vertices whose joints nearly flatten them are spread apart.
constexpr float kNormalTolerance = 1e-3f;

float uniform(std::mt19937& random) {
  return static_cast<float>(random() >> 8) * 0x1p-23f - 1.0f;
}
glm::vec3 uniform_3(std::mt19937& random) {
  const float x = uniform(random), y = uniform(random), z = uniform(random);
  return {x, y, z};
}

struct Making {
  bool skin, morph_positions, morph_frames;
};

/// `count` vertices anywhere, every three of them a triangle, of four joints and three morph targets.
std::shared_ptr<const Primitive> random_primitive(std::uint32_t count, const Making& making, std::uint32_t seed) {
  std::mt19937 random(seed);
  auto primitive = std::make_shared<Primitive>();
  for (std::uint32_t i = 0; i < count; ++i) {
    primitive->positions.push_back(2.0f * uniform_3(random));
    primitive->normals.push_back(glm::normalize(uniform_3(random)));
    primitive->tangents.push_back(glm::vec4(glm::normalize(uniform_3(random)), uniform(random) < 0.0f ? -1.0f : 1.0f));
    primitive->uv0.push_back({uniform(random), uniform(random)});
    primitive->colors.push_back(glm::vec4(0.25f));
    if (i % 3 == 2) primitive->indices.insert(primitive->indices.end(), {i - 2, i - 1, i});
    if (!making.skin) continue;
    primitive->joints.push_back(
        glm::uvec4(random() % 4, random() % 4, random() % 4, random() % 9));  // 4 to 8: the last
    const glm::vec4 weights = glm::abs(glm::vec4(uniform_3(random), uniform(random))) + 0.01f;
    primitive->weights.push_back(weights / (weights.x + weights.y + weights.z + weights.w));
  }
  for (int i = 0; i < 3 && (making.morph_positions || making.morph_frames); ++i) {
    MorphTarget& target = primitive->morph_targets.emplace_back();
    for (std::uint32_t v = 0; v < count; ++v) {
      if (making.morph_positions) target.positions.push_back(uniform_3(random));
      if (making.morph_frames) target.normals.push_back(0.3f * uniform_3(random));
      if (making.morph_frames && i != 1) target.tangents.push_back(0.3f * uniform_3(random));
    }
  }
  fill_bounds(*primitive);
  return primitive;
}

/// Turned, moved, stretched and, the second one, mirrored.
DeformedShape::JointMatrices random_matrices(std::uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<glm::mat4> matrices;
  for (int i = 0; i < 4; ++i) {
    glm::mat4 matrix = glm::translate(glm::mat4(1.0f), 3.0f * uniform_3(random));
    matrix = glm::rotate(matrix, 0.5f * uniform(random), glm::normalize(uniform_3(random)));
    matrices.push_back(glm::scale(matrix, glm::vec3(i == 1 ? -1.5f : 1.5f, 1.0f, 0.8f)));
  }
  return std::make_shared<const std::vector<glm::mat4>>(std::move(matrices));
}

glm::vec3 unpacked(std::uint32_t packed) {
  const auto number = [](std::uint32_t half) {
    return std::max(static_cast<float>(static_cast<std::int16_t>(half)) / 32767.0f, -1.0f);
  };
  glm::vec3 unit(number(packed & 0xffffu), number(packed >> 16), 0.0f);
  unit.z = 1.0f - std::abs(unit.x) - std::abs(unit.y);
  const float fold = std::max(-unit.z, 0.0f);
  unit.x += unit.x >= 0.0f ? -fold : fold;
  unit.y += unit.y >= 0.0f ? -fold : fold;
  return glm::normalize(unit);
}

void expect_same_way(std::uint32_t packed, std::uint32_t expected, const std::string& where) {
  EXPECT_LT(glm::distance(unpacked(packed), unpacked(expected)), kNormalTolerance) << where;
}

template <class T>
std::vector<T> read(const gl::Buffer& buffer, std::uint32_t first, std::size_t count) {
  std::vector<T> values(count);
  buffer.download(std::as_writable_bytes(std::span(values)), first * sizeof(T));
  return values;
}

/// What the processor makes of it.
Primitive deformed_by_processor(const Primitive& primitive, const DeformedShape& shape) {
  Primitive deformed = primitive;
  DeformedVertices vertices = shape.vertices();
  deformed.positions = std::move(vertices.positions);
  deformed.normals = std::move(vertices.normals);
  deformed.tangents = std::move(vertices.tangents);
  return deformed;
}

void expect_as_by_processor(const DeviceGeometry& geometry, const DeformTask& task, const std::string& name) {
  const Primitive expected = deformed_by_processor(*geometry.primitives()[task.primitive], *task.shape);
  const std::size_t vertices = expected.positions.size(), triangles = expected.indices.size() / 3;
  const auto positions = read<glm::vec3>(geometry.positions(), task.first_vertex, vertices);
  const auto packed = read<DeviceVertex>(geometry.vertices(), task.first_vertex, vertices);
  const std::vector<DeviceVertex> expected_vertices = pack_vertices(expected);
  for (std::size_t i = 0; i < vertices; ++i) {
    const std::string where = name + ", vertex " + std::to_string(i);
    EXPECT_LT(glm::distance(positions[i], expected.positions[i]), 2e-5f) << where;
    expect_same_way(packed[i].normal, expected_vertices[i].normal, where);
    expect_same_way(packed[i].tangent, expected_vertices[i].tangent, where);
    EXPECT_EQ(packed[i].tangent & 0x10000u, expected_vertices[i].tangent & 0x10000u) << where;
    EXPECT_EQ(packed[i].uv0, expected_vertices[i].uv0) << where;
    EXPECT_EQ(packed[i].color[3], expected_vertices[i].color[3]) << where;
  }
  const auto records = read<DeviceTriangle>(geometry.triangles(), task.first_triangle, triangles);
  const std::vector<DeviceTriangle> expected_records = pack_triangles(expected);
  for (std::size_t t = 0; t < triangles; ++t) {
    const std::string where = name + ", triangle " + std::to_string(t);
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(records[t].corners[k], expected_records[t].corners[k]) << where;
      expect_same_way(records[t].normals[k], expected_records[t].normals[k], where);
    }
    expect_same_way(records[t].geometric_normal, expected_records[t].geometric_normal, where);
    EXPECT_NEAR(records[t].uv_per_m, expected_records[t].uv_per_m, 1e-3f * expected_records[t].uv_per_m) << where;
  }
}

class DeformerTest : public ::testing::Test {
 protected:
  void run(const std::vector<DeformTask>& tasks, DeviceGeometry& geometry) {
    const gl::BufferTexture positions("positions", GL_RGB32F), vertices("vertices", GL_RGBA32UI),
        triangles("triangles", GL_RGBA32UI);
    positions.attach(geometry.positions());
    vertices.attach(geometry.vertices());
    triangles.attach(geometry.triangles());
    positions.bind(UNIT_POSITIONS);
    vertices.bind(UNIT_VERTICES);
    triangles.bind(UNIT_TRIANGLES);
    deformer_.run(tasks, geometry);
  }

  std::unique_ptr<gl::Context> context_ = gl::Context::create();
  gl::ShaderLibrary shaders_;
  Deformer deformer_{shaders_};
};

TEST_F(DeformerTest, MakesWhatTheProcessorMakes) {
  const Making makings[] = {{true, false, false}, {false, true, false}, {false, true, true},
                            {true, true, true},   {false, false, true}, {false, false, false}};
  std::vector<std::shared_ptr<const Primitive>> primitives;
  std::uint32_t seed = 1;
  for (const Making& making : makings) {
    primitives.push_back(random_primitive(60 + 33 * seed, making, seed));
    ++seed;
  }
  std::sort(primitives.begin(), primitives.end());
  DeviceGeometry geometry(primitives, gl::BufferUse::kDevice);
  std::vector<DeformTask> tasks;
  std::uint32_t vertex = geometry.rigid_vertices(), triangle = geometry.rigid_triangles();
  for (std::size_t i = 0; i < primitives.size(); ++i)
    for (std::uint32_t copy = 0; copy < 2; ++copy) {  // two instances of a primitive, shaped differently
      const bool skinned = !primitives[i]->joints.empty();
      tasks.push_back(
          {std::make_shared<DeformedShape>(primitives[i], skinned ? random_matrices(++seed) : nullptr,
                                           std::vector<float>{0.7f, 0.0f, -0.4f - static_cast<float>(copy)}),
           i, vertex, triangle});
      vertex += static_cast<std::uint32_t>(primitives[i]->positions.size());
      triangle += static_cast<std::uint32_t>(primitives[i]->indices.size() / 3);
    }
  geometry.reserve_deformed(vertex - geometry.rigid_vertices(), triangle - geometry.rigid_triangles());
  run(tasks, geometry);
  for (std::size_t i = 0; i < tasks.size(); ++i)
    expect_as_by_processor(geometry, tasks[i], "task " + std::to_string(i));
}

TEST_F(DeformerTest, GivesShapesTheirPositionsWhereTheProcessorCanReadThem) {
  const auto primitive = random_primitive(90, {true, true, true}, 5);
  DeviceGeometry geometry({primitive}, gl::BufferUse::kHostVisible);
  geometry.reserve_deformed(90, 30);
  const auto shape_of = [&](std::uint32_t seed) {
    return std::make_shared<DeformedShape>(primitive, random_matrices(seed), std::vector<float>{1.0f});
  };
  for (const std::uint32_t seed : {1u, 2u, 2u, 1u}) {  // the same twice: nothing is made anew, and yet they get theirs
    const DeformTask task{shape_of(seed), 0, geometry.rigid_vertices(), geometry.rigid_triangles()};
    run({task}, geometry);
    const auto made = read<glm::vec3>(geometry.positions(), task.first_vertex, 90);
    ASSERT_TRUE(std::ranges::equal(task.shape->positions(), made));
    expect_as_by_processor(geometry, task, "seed " + std::to_string(seed));
  }
}

TEST_F(DeformerTest, BoundsHoldEveryVertex) {
  for (std::uint32_t seed = 0; seed < 50; ++seed) {
    const auto primitive = random_primitive(60, {seed % 2 == 0, seed % 3 != 0, false}, seed);
    const DeformedShape shape(primitive, seed % 2 == 0 ? random_matrices(seed) : nullptr, {0.5f, -2.0f, 0.1f});
    for (const glm::vec3& p : shape.positions())
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_GE(p[axis], shape.bounds().min[axis] - 1e-4f);
        EXPECT_LE(p[axis], shape.bounds().max[axis] + 1e-4f);
      }
  }
}

}  // namespace
}  // namespace lightwell
