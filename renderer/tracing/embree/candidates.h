// Scaling up on the CPU: the candidates of a patch tried for all its pixels at once. See CandidateTest.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "renderer/tracing/embree/packet.h"
#include "renderer/tracing/tracer.h"

namespace lightwell {

/// A CandidateTest whose buffers have been mapped.
struct MappedCandidateTest {
  const PixelOrigin* pixels;
  const glm::vec4* directions;
  const Hit* candidates;
  const CandidateTest& test;
  Hit* hits;
};

/// Pixels that one call of `test_candidates` looks after at most.
constexpr std::uint32_t kChunkPixels = 256;

/// Tests all directions of the pixels [begin, end). `width`: rays that Embree takes at once.
template <int width>
void test_candidates(const EmbreeScene& scene, const MappedCandidateTest& mapped, HitListWriter& list,
                     std::uint32_t begin, std::uint32_t end);

}  // namespace lightwell
