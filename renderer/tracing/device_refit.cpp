#include "renderer/tracing/device_refit.h"

#include <algorithm>

#include "renderer/tracing/bindings.glsl"

namespace lightwell {

namespace {

constexpr std::uint32_t kGroup = 64;

// Of each node, how many stand one below the other from it down to a leaf, less one.
std::vector<std::uint32_t> heights_of(const Bvh& bvh) {
  std::vector<std::uint32_t> heights(bvh.nodes.size(), 0);
  for (std::size_t i = bvh.nodes.size(); i-- > 0;)
    for (const std::uint32_t child : bvh.nodes[i].children)
      if (!BvhChild::is_leaf(child)) heights[i] = std::max(heights[i], heights[child] + 1);
  return heights;
}

}  // namespace

DeviceRefit::Step::Step(gl::ShaderLibrary& shaders, const char* path)
    : program(shaders.compute(path)),
      first_word_uniform(program, "first_word"),
      count_uniform(program, "count"),
      first_triangle(program, "first_triangle"),
      first_vertex(program, "first_vertex"),
      first_node(program, "first_node") {}

void DeviceRefit::Step::run(std::uint32_t first_word, std::uint32_t count, std::uint32_t invocations) const {
  first_word_uniform = first_word;
  count_uniform = count;
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  program->dispatch(invocations, kGroup);
}

DeviceRefit::DeviceRefit(gl::ShaderLibrary& shaders)
    : words_("how hierarchies are refitted", sizeof(std::uint32_t)),
      triangles_(shaders, "tracing/refit_triangles.comp"),
      nodes_(shaders, "tracing/refit_nodes.comp"),
      cost_(shaders, "tracing/refit_cost.comp") {}

DeviceRefit::Plan DeviceRefit::plan(const Bvh& bvh, const Primitive& primitive, std::uint32_t first_node) {
  Plan plan;
  std::vector<std::uint32_t> corners;
  for (const std::uint32_t item : bvh.items)
    corners.insert(corners.end(), &primitive.indices[std::size_t{3} * item],
                   &primitive.indices[std::size_t{3} * item] + 3);
  plan.corners = words_.allocate(static_cast<std::uint32_t>(corners.size()));
  words_.upload(plan.corners, std::span<const std::uint32_t>(corners));

  const std::vector<std::uint32_t> heights = heights_of(bvh);
  std::vector<std::uint32_t> order(heights.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::stable_sort(order, {}, [&](std::uint32_t node) { return heights[node]; });
  for (std::uint32_t i = 0; i < order.size(); ++i)
    if (i == 0 || heights[order[i]] != heights[order[i - 1]]) plan.first_orders.push_back(i);
  plan.first_orders.push_back(static_cast<std::uint32_t>(order.size()));
  for (std::uint32_t& node : order) node += first_node;
  plan.order = words_.allocate(static_cast<std::uint32_t>(order.size()));
  words_.upload(plan.order, std::span<const std::uint32_t>(order));
  plan.cost = gl::Buffer("cost of a hierarchy", sizeof(float), gl::BufferUse::kHostVisible);
  return plan;
}

void DeviceRefit::run(Plan& plan, const DeviceBvh& bvh, const gl::Buffer& positions,
                      std::uint32_t first_position) const {
  bvh.nodes.bind_storage(TRACE_BINDING_NODES);
  bvh.triangles.bind_storage(TRACE_BINDING_TRIANGLES);
  words_.bind_storage(TRACE_BINDING_REFIT_WORDS);
  positions.bind_storage(TRACE_BINDING_POSITIONS);
  plan.cost.bind_storage(TRACE_BINDING_REFIT_COST);
  triangles_.first_triangle = bvh.first_triangle;
  triangles_.first_vertex = first_position;
  triangles_.run(plan.corners.first(), bvh.triangle_count, bvh.triangle_count);
  for (std::size_t i = 0; i + 1 < plan.first_orders.size(); ++i) {
    const std::uint32_t count = plan.first_orders[i + 1] - plan.first_orders[i];
    nodes_.run(plan.order.first() + plan.first_orders[i], count, count);
  }
  if (bvh.node_count == 0) return;
  cost_.first_node = bvh.first_node;
  cost_.run(0, bvh.node_count, kGroup);
  plan.fitted.set();
}

float DeviceRefit::cost(Plan& plan) {
  if (!plan.fitted) return 0.0f;
  plan.fitted.wait();
  return *reinterpret_cast<const float*>(plan.cost.host());
}

}  // namespace lightwell
