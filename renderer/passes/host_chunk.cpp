#include "renderer/passes/host_chunk.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <span>

namespace lightwell {

namespace {

constexpr float kNothing = std::numeric_limits<float>::infinity();

}  // namespace

HostChunk::HostChunk(const HostBatch& batch, TriangleCache& triangles, std::uint32_t begin, std::uint32_t end)
    : batch_(batch),
      triangles_(triangles),
      first_(begin),
      count_(end - begin),
      surfaces_(batch.group_count + kMoreCandidates),
      candidates_(surfaces_.size()),
      candidate_hits_(surfaces_.size()) {
  lanes::PackedReceivers packed;
  std::memset(&packed, 0, sizeof packed);  // what lies beyond the last pixel is computed with, too
  std::memset(&pixels_, 0, sizeof pixels_);
  singles_.count = singles_.entry_count = 0;
  sort_by_patch();
  for (std::uint32_t i = 0; i < count_; ++i) {
    const PackedReceiver& receiver = batch.receivers[begin + places_[i]];
    packed.normal[i] = receiver.normal;
    packed.geometric_normal[i] = receiver.geometric_normal;
    packed.base_color_rg[i] = receiver.base_color_rg;
    packed.base_color_b_metallic[i] = receiver.base_color_b_metallic;
    packed.material_roughness[i] = receiver.material_roughness;
    packed.dielectric[i] = receiver.dielectric;
    packed.to_camera[i] = receiver.to_camera;
    add_origin(i, batch.origins[begin + places_[i]]);
  }
  kernels_.unpack(packed, pixels_);
}

void HostChunk::run() {
  for (std::uint32_t direction = 0; direction < batch_.direction_count; ++direction)
    for (std::uint32_t r = 0; r < run_count_; ++r) {
      prefetch(runs_[r], direction + 4);
      gather(runs_[r], direction);
    }
  finish_singles();
  scattered_.finish();
}

void HostChunk::add_to(glm::vec4* sums, bool is_first) const {
  for (std::uint32_t i = 0; i < count_; ++i) {
    const glm::vec3 sum(pixels_.sum[0][i], pixels_.sum[1][i], pixels_.sum[2][i]);
    const float hits = pixels_.hit_count[i];
    glm::vec4& out = sums[first_ + places_[i]];
    out = is_first ? glm::vec4(sum, hits > 0.0f ? pixels_.distance[i] / hits : 0.0f) : out + glm::vec4(sum, 0.0f);
  }
}

// Those of a patch side by side, in their order.
void HostChunk::sort_by_patch() {
  std::array<std::uint64_t, lanes::kChunkPixels> keys;
  for (std::uint32_t i = 0; i < count_; ++i) keys[i] = std::uint64_t{batch_.origins[first_ + i].patch_index} << 32 | i;
  if (!std::is_sorted(keys.begin(), keys.begin() + count_)) std::sort(keys.begin(), keys.begin() + count_);
  for (std::uint32_t i = 0; i < count_; ++i) places_[i] = static_cast<std::uint32_t>(keys[i]);
}

void HostChunk::add_origin(std::uint32_t i, const PixelOrigin& origin) {
  for (int axis = 0; axis < 3; ++axis) {
    pixels_.above[axis][i] = origin.above_ws[axis];
    pixels_.down[axis][i] = origin.down_ws[axis];
  }
  if (origin.patch_index == kNoPatch) return;
  if (run_count_ == 0 || runs_[run_count_ - 1].pixels.end != i ||
      runs_[run_count_ - 1].patch_index != origin.patch_index)
    runs_[run_count_++] = {{i, i}, origin.patch_index, false};
  PatchRun& run = runs_[run_count_ - 1];
  run.is_alone = ++run.pixels.end - run.pixels.begin == 1 && origin.is_patch != 0;
}

// A patch's directions lie far apart, which the processor does not foresee.
void HostChunk::prefetch(const PatchRun& run, std::uint32_t direction_index) const {
  const std::size_t ray = std::size_t{direction_index} * batch_.patch_count + run.patch_index;
  __builtin_prefetch(&batch_.directions[ray]);
  __builtin_prefetch(&batch_.candidates[ray]);
}

void HostChunk::gather(const PatchRun& run, std::uint32_t direction_index) {
  const std::size_t ray = std::size_t{direction_index} * batch_.patch_count + run.patch_index;
  const lanes::PatchDirection& direction = batch_.directions[ray];
  if (direction.pdf <= 0.0f) return;
  if (run.is_alone && batch_.group_count == 1)
    return scatter_alone(run.pixels.begin, direction, batch_.candidates[ray]);
  kernels_.start_rays(pixels_, run.pixels, direction);
  candidate_count_ = 0;
  for (std::uint32_t group = 0; group < batch_.group_count; ++group) {
    const Hit& candidate = batch_.candidates[std::size_t{group} * batch_.direction_count * batch_.patch_count + ray];
    if (candidate.t >= 0.0f)
      try_candidate(run.pixels, candidate.instance, candidate.triangle * batch_.group_count + group, direction);
  }
  if (batch_.trace_missed && candidate_count_ > 0) trace_missed(run.pixels, direction);
  if (run.pixels.end - run.pixels.begin < kLongRun)
    scatter(run.pixels, direction);
  else
    kernels_.gather(pixels_, run.pixels, direction, candidates_.data(), candidate_count_, batch_.environment);
}

// What the pixel's own patch meets is what it meets itself. As start_rays() of the kernels.
void HostChunk::scatter_alone(std::uint32_t pixel, const lanes::PatchDirection& direction, const Hit& hit) {
  const PixelOrigin& origin = batch_.origins[first_ + places_[pixel]];
  const bool is_down = glm::dot(origin.down_ws, lanes::along(direction)) > 0.0f;
  scattered_.add(pixel, is_down ? origin.above_ws + origin.down_ws : origin.above_ws, direction, hit);
}

// Where the ray at hand starts.
glm::vec3 HostChunk::start_of(std::uint32_t pixel) const {
  return {pixels_.from[0][pixel], pixels_.from[1][pixel], pixels_.from[2][pixel]};
}

void HostChunk::scatter(lanes::PixelRun run, const lanes::PatchDirection& direction) {
  for (std::uint32_t i = run.begin; i < run.end; ++i) {
    if (pixels_.t[i] < 0.0f) continue;
    const bool is_hit = pixels_.t[i] < kNothing;
    Hit hit = is_hit ? candidate_hits_[pixels_.candidate[i]] : Hit{kMiss, 0, 0, 0.0f, 0.0f};
    if (is_hit) hit.t = pixels_.t[i], hit.u = pixels_.u[i], hit.v = pixels_.v[i];
    scattered_.add(i, start_of(i), direction, hit);
  }
}

void HostChunk::try_candidate(lanes::PixelRun run, std::uint32_t instance, std::uint32_t triangle,
                              const lanes::PatchDirection& direction) {
  const PlacedTriangle& placed = triangles_.at(instance, triangle);
  const lanes::AffineTriangle affine = lanes::affine_triangle(placed.corners_ws, lanes::along(direction));
  kernels_.meet(pixels_, run, affine, candidate_count_);
  add_candidate(placed, lanes::along(direction));
}

void HostChunk::add_candidate(const PlacedTriangle& placed, glm::vec3 direction) {
  surfaces_[candidate_count_] = placed.surface;
  candidates_[candidate_count_] = {&surfaces_[candidate_count_], side_of(placed.surface, direction)};
  candidate_hits_[candidate_count_] = {kMiss, placed.instance, placed.triangle, 0.0f, 0.0f};
  ++candidate_count_;
}

// Pixels that meet no candidate trace the ray themselves. A few triangles so found become candidates.
void HostChunk::trace_missed(lanes::PixelRun run, const lanes::PatchDirection& direction) {
  kernels_.collect_missed(pixels_, run, missed_);
  if (missed_.count == 0) return;
  if (batch_.hierarchy)
    trace_together(*batch_.hierarchy, direction);
  else if (batch_.compact)
    trace_singly(direction);
  else
    trace(direction);
  traced_ += missed_.count;
}

void HostChunk::trace_together(const WideHierarchy& hierarchy, const lanes::PatchDirection& direction) {
  for (int axis = 0; axis < 3; ++axis) missed_.direction_ws[axis] = direction.direction_ws[axis];
  kernels_.nearest_hits(hierarchy, missed_);
  for (std::uint32_t n = 0; n < missed_.count; ++n) {
    if (!(missed_.t[n] < kNothing)) continue;
    const WideLeaf& leaf = hierarchy.leaves[missed_.triangle[n] / kWide];
    const std::uint32_t which = missed_.triangle[n] % kWide;
    keep_hit(missed_.pixel[n], direction,
             {missed_.t[n], leaf.instance[which], leaf.triangle[which], missed_.u[n], missed_.v[n]});
  }
}

// Puts them off until many can be traced at once.
void HostChunk::trace_singly(const lanes::PatchDirection& direction) {
  if (singles_.count + missed_.count > lanes::SingleRays::kMost ||
      singles_.entry_count == lanes::SingleRays::kMostEntries)
    finish_singles();
  for (int axis = 0; axis < 3; ++axis) missed_.direction_ws[axis] = direction.direction_ws[axis];
  kernels_.find_entry(*batch_.compact, missed_, singles_.entries[singles_.entry_count]);
  if (singles_.entries[singles_.entry_count].count == 0) return;
  for (std::uint32_t n = 0; n < missed_.count; ++n) {
    const std::uint32_t at = singles_.count++;
    singles_.pixel[at] = missed_.pixel[n];
    for (int axis = 0; axis < 3; ++axis) {
      singles_.from[axis][at] = missed_.from[axis][n];
      singles_.direction_ws[axis][at] = direction.direction_ws[axis];
    }
    singles_.pdf[at] = direction.pdf;
    singles_.entry[at] = static_cast<std::uint8_t>(singles_.entry_count);
    pixels_.t[missed_.pixel[n]] = kMiss;
  }
  ++singles_.entry_count;
}

void HostChunk::finish_singles() {
  if (singles_.count == 0) return;
  kernels_.nearest_single_hits(*batch_.compact, singles_);
  for (std::uint32_t n = 0; n < singles_.count; ++n)
    if (singles_.t[n] < kNothing) triangles_.prefetch(singles_.instance[n], singles_.triangle[n]);
  for (std::uint32_t n = 0; n < singles_.count; ++n) {
    const auto vector = [&](const lanes::SingleRays::Row(&rows)[3]) {
      return glm::vec3(rows[0][n], rows[1][n], rows[2][n]);
    };
    lanes::PatchDirection direction;
    lanes::assign(direction.direction_ws, vector(singles_.direction_ws));
    direction.pdf = singles_.pdf[n];
    const Hit hit{singles_.t[n] < kNothing ? singles_.t[n] : kMiss, singles_.instance[n], singles_.triangle[n],
                  singles_.u[n], singles_.v[n]};
    scattered_.add(singles_.pixel[n], vector(singles_.from), direction, hit);
  }
  singles_.count = singles_.entry_count = 0;
}

void HostChunk::trace(const lanes::PatchDirection& direction) {
  for (std::uint32_t n = 0; n < missed_.count; ++n)
    missed_rays_[n] = {
        {missed_.from[0][n], missed_.from[1][n], missed_.from[2][n]}, 0.0f, lanes::along(direction), 1e30f};
  batch_.tracer.closest_hits(std::span(missed_rays_).first(missed_.count),
                             std::span(missed_hits_).first(missed_.count));
  // Among small triangles no two rays meet the same one, and each lies far from the last.
  for (std::uint32_t n = 0; n < missed_.count; ++n)
    if (missed_hits_[n].t >= 0.0f) triangles_.prefetch(missed_hits_[n].instance, missed_hits_[n].triangle);
  for (std::uint32_t n = 0; n < missed_.count; ++n)
    if (missed_hits_[n].t >= 0.0f) keep_hit(missed_.pixel[n], direction, missed_hits_[n]);
}

void HostChunk::keep_hit(std::uint32_t pixel, const lanes::PatchDirection& direction, const Hit& hit) {
  const std::uint32_t candidate = candidate_of(hit.instance, hit.triangle, direction);
  if (candidate == candidates_.size()) {
    pixels_.t[pixel] = kMiss;
    return scattered_.add(pixel, start_of(pixel), direction, hit);
  }
  pixels_.t[pixel] = hit.t;
  pixels_.u[pixel] = hit.u;
  pixels_.v[pixel] = hit.v;
  pixels_.candidate[pixel] = candidate;
}

// Past all of them if there is no room for one more. The last ones found are the likeliest.
std::uint32_t HostChunk::candidate_of(std::uint32_t instance, std::uint32_t triangle,
                                      const lanes::PatchDirection& direction) {
  for (std::uint32_t candidate = candidate_count_; candidate-- > 0;)
    if (candidate_hits_[candidate].instance == instance && candidate_hits_[candidate].triangle == triangle)
      return candidate;
  if (candidate_count_ == candidates_.size()) return candidate_count_;
  add_candidate(triangles_.at_hit(instance, triangle), lanes::along(direction));
  return candidate_count_ - 1;
}

}  // namespace lightwell
