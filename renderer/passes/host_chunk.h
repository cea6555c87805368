// The pixels of the indirect map that a thread takes at a time: all directions of a batch, all that they meet.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "renderer/passes/patches.h"
#include "renderer/passes/scattered_hits.h"

namespace lightwell {

/// What a batch of HostGatherPass is, on the processor.
struct HostBatch {
  const PixelOrigin* origins;
  const PackedReceiver* receivers;
  const lanes::PatchDirection* directions;
  const Hit* candidates;
  std::uint32_t patch_count, direction_count, group_count;
  bool trace_missed;
  DeviceScene::HostHitData scene;
  const lanes::LightEnvironment& environment;
  const HostTracer& tracer;
  // What pixels meet beside the candidates is found in one of these; if both are null, by the tracer.
  const WideHierarchy* hierarchy;
  const CompactHierarchy* compact;
};
static_assert(sizeof(lanes::PatchDirection) == sizeof(glm::vec4));

class HostChunk {
 public:
  /// Pixels with the slots [begin, end), at most lanes::kChunkPixels.
  HostChunk(const HostBatch& batch, TriangleCache& triangles, std::uint32_t begin, std::uint32_t end);

  void run();

  /// The sums over the directions; in w, if they are the first, the mean distance of the hits in metres.
  void add_to(glm::vec4* sums, bool is_first) const;

  /// How many rays were traced that met none of their patch's candidates.
  std::uint32_t traced() const { return traced_; }

 private:
  struct PatchRun {
    lanes::PixelRun pixels;
    std::uint32_t patch_index;
    bool is_alone;  // the pixel is the patch
  };
  void sort_by_patch();
  glm::vec3 start_of(std::uint32_t pixel) const;
  void add_origin(std::uint32_t i, const PixelOrigin& origin);
  void prefetch(const PatchRun& run, std::uint32_t direction_index) const;
  void gather(const PatchRun& run, std::uint32_t direction_index);
  void scatter_alone(std::uint32_t pixel, const lanes::PatchDirection& direction, const Hit& hit);
  void scatter(lanes::PixelRun run, const lanes::PatchDirection& direction);
  void try_candidate(lanes::PixelRun run, std::uint32_t instance, std::uint32_t triangle,
                     const lanes::PatchDirection& direction);
  void add_candidate(const PlacedTriangle& placed, glm::vec3 direction);
  void trace_missed(lanes::PixelRun run, const lanes::PatchDirection& direction);
  void trace(const lanes::PatchDirection& direction);
  void trace_singly(const lanes::PatchDirection& direction);
  void finish_singles();
  void trace_together(const WideHierarchy& hierarchy, const lanes::PatchDirection& direction);
  void keep_hit(std::uint32_t pixel, const lanes::PatchDirection& direction, const Hit& hit);
  std::uint32_t candidate_of(std::uint32_t instance, std::uint32_t triangle, const lanes::PatchDirection& direction);

  static constexpr std::uint32_t kLongRun = 4;         // pixels, from which on whole vectors pay
  static constexpr std::uint32_t kMoreCandidates = 4;  // each costs as much as a vector of scattered rays

  const lanes::PatchKernels& kernels_ = lanes::patch_kernels();
  const HostBatch& batch_;
  TriangleCache& triangles_;
  const std::uint32_t first_, count_;
  std::array<std::uint32_t, lanes::kChunkPixels> places_;  // of the pixels among the slots
  lanes::PatchPixels pixels_;
  ScatteredHits scattered_{pixels_, triangles_, batch_.environment};
  std::array<PatchRun, lanes::kChunkPixels> runs_;
  std::uint32_t run_count_ = 0;
  std::vector<lanes::HitSurface> surfaces_;  // of the candidates of the direction at hand
  std::vector<lanes::Candidate> candidates_;
  std::vector<Hit> candidate_hits_;
  std::uint32_t candidate_count_ = 0;
  lanes::ParallelRays missed_;
  lanes::SingleRays singles_;
  std::array<Ray, lanes::kChunkPixels> missed_rays_;
  std::array<Hit, lanes::kChunkPixels> missed_hits_;
  std::uint32_t traced_ = 0;
};

}  // namespace lightwell
