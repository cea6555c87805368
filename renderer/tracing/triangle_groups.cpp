#include "renderer/tracing/triangle_groups.h"

#include <algorithm>
#include <utility>

namespace lightwell {

namespace {

// What a tracer looks at, with every `count`-th triangle from `group` on.
std::shared_ptr<const Primitive> part_of(const Primitive& primitive, std::uint32_t group, std::uint32_t count) {
  auto part = std::make_shared<Primitive>();
  part->positions = primitive.positions;
  part->uv0 = primitive.uv0;
  part->uv1 = primitive.uv1;
  for (std::size_t corner = std::size_t{3} * group; corner + 2 < primitive.indices.size();
       corner += std::size_t{3} * count)
    part->indices.insert(part->indices.end(), primitive.indices.begin() + static_cast<std::ptrdiff_t>(corner),
                         primitive.indices.begin() + static_cast<std::ptrdiff_t>(corner + 3));
  return part;
}

}  // namespace

TriangleGroups::TriangleGroups(std::function<std::unique_ptr<Tracer>()> make_tracer)
    : make_tracer_(std::move(make_tracer)) {}

const TriangleGroups::Parts& TriangleGroups::parts_of(Groups& groups,
                                                      const std::shared_ptr<const Primitive>& primitive) const {
  Parts& parts = groups.primitives[primitive.get()];
  parts.last_used = frame_;
  if (parts.whole) return parts;
  parts.whole = primitive;
  const auto count = static_cast<std::uint32_t>(groups.tracers.size());
  for (std::uint32_t group = 0; group < count; ++group) parts.parts.push_back(part_of(*primitive, group, count));
  return parts;
}

void TriangleGroups::update(const TraceScene& scene, std::uint32_t count) {
  ++frame_;
  current_ = &kept_[count];
  current_->last_used = frame_;
  while (current_->tracers.size() < count) current_->tracers.push_back(make_tracer_());
  for (std::uint32_t group = 0; group < count; ++group) {
    std::vector<Instance> instances(scene.instances.begin(), scene.instances.end());
    for (Instance& instance : instances) instance.primitive = parts_of(*current_, instance.primitive).parts[group];
    current_->tracers[group]->update({instances, scene.coverage, scene.device_positions});
  }
  drop_unused();
}

void TriangleGroups::drop_unused() {
  std::map<const Primitive*, long> holders;  // how many of ours hold it
  for (const auto& [count, groups] : kept_)
    for (const auto& [primitive, parts] : groups.primitives) ++holders[primitive];
  std::vector<const Primitive*> gone;  // from every scene, by an edit or with its session
  for (const auto& [count, groups] : kept_)
    for (const auto& [primitive, parts] : groups.primitives)
      if (parts.whole.use_count() <= holders[primitive]) gone.push_back(primitive);
  for (auto& [count, groups] : kept_)
    std::erase_if(groups.primitives, [&](const auto& entry) {
      return std::find(gone.begin(), gone.end(), entry.first) != gone.end() ||
             entry.second.last_used + kFramesUntilDropped < frame_;
    });
  std::erase_if(kept_, [&](const auto& entry) { return &entry.second != current_ && entry.second.primitives.empty(); });
  while (kept_.size() > kMostKept)
    kept_.erase(std::min_element(kept_.begin(), kept_.end(),
                                 [](const auto& a, const auto& b) { return a.second.last_used < b.second.last_used; }));
}

void TriangleGroups::closest_hits(const gl::Buffer& rays, std::uint32_t count, gl::Buffer& hits, gl::Buffer& scratch) {
  const auto bytes = static_cast<GLsizeiptr>(std::uint64_t{count} * sizeof(Hit));
  for (std::size_t group = 0; group < current_->tracers.size(); ++group) {
    current_->tracers[group]->closest_hit(rays, count, scratch);
    glCopyNamedBufferSubData(scratch.id(), hits.id(), 0, static_cast<GLintptr>(group) * bytes, bytes);
    gl::wait_for_device();  // before the scratch buffer is written again
  }
}

}  // namespace lightwell
