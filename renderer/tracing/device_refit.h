// Fits hierarchies to deformed vertices on the device: nothing comes back but how good they still are.
#pragma once

#include <cstdint>
#include <vector>

#include "renderer/gl/fence.h"
#include "renderer/gl/program.h"
#include "renderer/tracing/bvh.h"
#include "renderer/tracing/device_pool.h"
#include "renderer/tracing/tracer.h"

namespace lightwell {

/// What is to be fitted: nodes and triangles in their pools, in the order of the Bvh.
struct DeviceBvh {
  const DevicePool& nodes;
  const DevicePool& triangles;
  std::uint32_t first_node, node_count;
  std::uint32_t first_triangle, triangle_count;
};

class DeviceRefit {
 public:
  /// How a hierarchy is fitted. Move-only.
  struct Plan {
    PoolRange corners;                        // three vertices for each triangle
    PoolRange order;                          // of nodes, children before parents
    std::vector<std::uint32_t> first_orders;  // nodes from one of these to the next can be fitted at once
    gl::Buffer cost;                          // a float, once `fitted` is passed
    gl::Fence fitted;
  };

  explicit DeviceRefit(gl::ShaderLibrary& shaders);

  /// For `bvh` over the triangles of `primitive`, whose nodes stand from `first_node` on.
  Plan plan(const Bvh& bvh, const Primitive& primitive, std::uint32_t first_node);

  /// Fits to positions from `first_position` on.
  void run(Plan& plan, const DeviceBvh& bvh, const gl::Buffer& positions, std::uint32_t first_position) const;

  /// expected_cost() after the last run; 0 if there was none, or no node. A frame after it, it does not wait.
  static float cost(Plan& plan);

  std::uint64_t memory_bytes() const { return words_.size_bytes(); }

 private:
  // One of the programs.
  struct Step {
    Step(gl::ShaderLibrary& shaders, const char* path);
    void run(std::uint32_t first_word, std::uint32_t count, std::uint32_t invocations) const;
    gl::ProgramPtr program;
    gl::Uniform<std::uint32_t> first_word_uniform, count_uniform, first_triangle, first_vertex, first_node;
  };
  DevicePool words_;
  Step triangles_, nodes_, cost_;
};

}  // namespace lightwell
