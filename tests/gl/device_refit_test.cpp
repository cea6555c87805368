// Hierarchies fitted by the device against those that the processor fits.
#include "renderer/tracing/device_refit.h"

#include <gtest/gtest.h>

#include "renderer/gl/device.h"
#include "tests/gl/trace_scenes.h"

namespace lightwell::test {
namespace {

std::vector<Box> boxes_of(const Primitive& primitive, std::span<const glm::vec3> positions) {
  std::vector<Box> boxes(primitive.indices.size() / 3);
  for (std::size_t i = 0; i < primitive.indices.size(); ++i) boxes[i / 3].add(positions[primitive.indices[i]]);
  return boxes;
}

// Two hierarchies in the same pools, of which the second is fitted. Its cost is a sum over all its boxes.
TEST(DeviceRefit, CostsWhatTheProcessorsCosts) {
  const auto context = gl::Context::create();
  gl::ShaderLibrary shaders;
  DeviceRefit refit(shaders);
  for (const std::uint32_t count : {5u, 6u, 100u, 3000u}) {
    const auto primitive = random_triangles(count, 0.5f, count);
    Bvh bvh = build_bvh(boxes_of(*primitive, primitive->positions), {4, 40}, nullptr);
    const auto node_count = static_cast<std::uint32_t>(bvh.nodes.size());
    DevicePool nodes("nodes", sizeof(BvhNode)), triangles("triangles", 48);
    const PoolRange other_nodes = nodes.allocate(7), other_triangles = triangles.allocate(11);
    const PoolRange own_nodes = nodes.allocate(node_count), own_triangles = triangles.allocate(count);
    std::vector<BvhNode> placed = bvh.nodes;
    for (BvhNode& node : placed)
      for (std::uint32_t& child : node.children)
        child += BvhChild::is_leaf(child) ? own_triangles.first() : own_nodes.first();
    nodes.upload(own_nodes, std::span<const BvhNode>(placed));
    DeviceRefit::Plan plan = refit.plan(bvh, *primitive, own_nodes.first());
    EXPECT_EQ(DeviceRefit::cost(plan), 0.0f) << "before it was fitted";

    std::vector<glm::vec3> positions(13, glm::vec3(1e9f));  // of others
    for (const glm::vec3& p : primitive->positions) positions.push_back({p.y * p.y, 2.0f * p.x, p.z + p.x * p.y});
    gl::Buffer buffer("positions", positions.size() * sizeof(glm::vec3));
    buffer.upload(std::span<const glm::vec3>(positions));
    refit.run(plan, {nodes, triangles, own_nodes.first(), node_count, own_triangles.first(), count}, buffer, 13);
    refit_bvh(bvh, boxes_of(*primitive, std::span(positions).subspan(13)));
    EXPECT_NEAR(DeviceRefit::cost(plan), expected_cost(bvh), 1e-4f * expected_cost(bvh)) << count << " triangles";
  }
}

}  // namespace
}  // namespace lightwell::test
