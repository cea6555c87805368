#include "renderer/tracing/device_coverage.h"

#include <algorithm>

#include "renderer/check.h"
#include "renderer/tracing/bindings.glsl"
#include "renderer/tracing/upload_if_changed.h"

namespace lightwell {

DeviceCoverageTests::DeviceCoverageTests()
    : corner_uvs_("texture coordinates for coverage", sizeof(glm::vec2)),
      alpha_("alpha planes for coverage", sizeof(std::uint32_t)),
      buffer_("coverage tests", 0) {}

std::vector<bool> DeviceCoverageTests::update(const TraceScene& scene, std::uint64_t patience) {
  LIGHTWELL_CHECK_OP(scene.instances.size(), ==, scene.coverage.size());
  ++frame_;
  std::vector<bool> filtered;
  std::vector<DeviceCoverage> tests;
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const CoverageTest test = prepare_coverage(scene.coverage[i], *scene.instances[i].primitive, alpha_ranges_);
    filtered.push_back(test.outcome != CoverageTest::Outcome::kAlwaysHit);
    tests.push_back(device_coverage(test, scene, i));
  }
  are_needed_ = std::find(filtered.begin(), filtered.end(), true) != filtered.end();
  if (are_needed_) upload_if_changed(buffer_, tests_, std::move(tests));
  const auto is_unused = [&](std::uint64_t last_used) { return last_used + patience < frame_; };
  std::erase_if(corners_, [&](const auto& entry) { return is_unused(entry.second.last_used); });
  std::erase_if(planes_, [&](const auto& entry) { return is_unused(entry.second.last_used); });
  alpha_ranges_.drop_unused();
  return filtered;
}

void DeviceCoverageTests::bind() const {
  buffer_.bind_storage(TRACE_BINDING_COVERAGE);
  corner_uvs_.bind_storage(TRACE_BINDING_CORNER_UVS);
  alpha_.bind_storage(TRACE_BINDING_ALPHA);
}

std::uint64_t DeviceCoverageTests::memory_bytes() const {
  return corner_uvs_.size_bytes() + alpha_.size_bytes() + buffer_.size_bytes();
}

DeviceCoverage DeviceCoverageTests::device_coverage(const CoverageTest& test, const TraceScene& scene,
                                                    std::size_t instance) {
  DeviceCoverage packed{};
  packed.outcome = static_cast<std::uint32_t>(test.outcome);
  packed.min_texel = test.min_texel;
  packed.blend_factor = test.blend_factor;
  packed.wraps = static_cast<std::uint32_t>(test.wrap_s) | static_cast<std::uint32_t>(test.wrap_t) << 8;
  packed.u_row = glm::vec4(test.u_row, 0.0f);
  packed.v_row = glm::vec4(test.v_row, 0.0f);
  const bool reads_image =
      test.outcome == CoverageTest::Outcome::kMask || test.outcome == CoverageTest::Outcome::kBlend;
  if (!test.image || !reads_image) return packed;
  packed.first_texel = first_texel(scene.coverage[instance].image);
  packed.width_px = static_cast<std::uint32_t>(test.image->size_px.x);
  packed.height_px = static_cast<std::uint32_t>(test.image->size_px.y);
  packed.first_corner = first_corner(scene.instances[instance].primitive, test.uv_set);
  return packed;
}

std::uint32_t DeviceCoverageTests::first_corner(const std::shared_ptr<const Primitive>& primitive, int uv_set) {
  CornerUvs& corners = corners_[{primitive.get(), uv_set}];
  corners.last_used = frame_;
  if (corners.primitive) return corners.range.first();
  const auto& uvs = uv_set == 0 ? primitive->uv0 : primitive->uv1;
  std::vector<glm::vec2> unrolled;
  unrolled.reserve(primitive->indices.size());
  for (const std::uint32_t index : primitive->indices) unrolled.push_back(uvs[index]);
  corners.range = corner_uvs_.allocate(static_cast<std::uint32_t>(unrolled.size()));
  corner_uvs_.upload(corners.range, std::span<const glm::vec2>(unrolled));
  corners.primitive = primitive;
  return corners.range.first();
}

std::uint32_t DeviceCoverageTests::first_texel(const std::shared_ptr<const Image>& image) {
  AlphaPlane& plane = planes_[image.get()];
  plane.last_used = frame_;
  if (!plane.image) {
    std::vector<std::uint32_t> words((image->rgba.size() / 4 + 3) / 4);
    for (std::size_t texel = 0; texel < image->rgba.size() / 4; ++texel)
      words[texel / 4] |= std::uint32_t{image->rgba[4 * texel + 3]} << (8 * (texel % 4));
    plane.words = alpha_.allocate(static_cast<std::uint32_t>(words.size()));
    alpha_.upload(plane.words, std::span<const std::uint32_t>(words));
    plane.image = image;
  }
  return 4 * plane.words.first();
}

}  // namespace lightwell
