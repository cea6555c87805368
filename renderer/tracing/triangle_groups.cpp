#include "renderer/tracing/triangle_groups.h"

#include <utility>

namespace lightwell {

namespace {

constexpr std::uint64_t kFramesUntilDropped = 120;

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

const TriangleGroups::Parts& TriangleGroups::parts_of(const std::shared_ptr<const Primitive>& primitive,
                                                      std::uint32_t count) {
  Parts& parts = primitives_[primitive.get()];
  parts.last_used = frame_;
  if (parts.parts.size() == count) return parts;
  parts.whole = primitive;
  parts.parts.clear();
  for (std::uint32_t group = 0; group < count; ++group) parts.parts.push_back(part_of(*primitive, group, count));
  return parts;
}

void TriangleGroups::update(const TraceScene& scene, std::uint32_t count) {
  ++frame_;
  tracers_.resize(count);
  for (std::unique_ptr<Tracer>& tracer : tracers_)
    if (!tracer) tracer = make_tracer_();
  for (std::uint32_t group = 0; group < count; ++group) {
    std::vector<Instance> instances(scene.instances.begin(), scene.instances.end());
    for (Instance& instance : instances) instance.primitive = parts_of(instance.primitive, count).parts[group];
    tracers_[group]->update({instances, scene.coverage});
  }
  std::erase_if(primitives_, [&](const auto& entry) { return entry.second.last_used + kFramesUntilDropped < frame_; });
}

void TriangleGroups::closest_hits(const gl::Buffer& rays, std::uint32_t count, gl::Buffer& hits, gl::Buffer& scratch) {
  const auto bytes = static_cast<GLsizeiptr>(std::uint64_t{count} * sizeof(Hit));
  for (std::size_t group = 0; group < tracers_.size(); ++group) {
    tracers_[group]->closest_hit(rays, count, scratch);
    glCopyNamedBufferSubData(scratch.id(), hits.id(), 0, static_cast<GLintptr>(group) * bytes, bytes);
    gl::wait_for_device();  // before the scratch buffer is written again
  }
}

}  // namespace lightwell
