#include "renderer/tracing/coverage.h"

#include <algorithm>
#include <cmath>

namespace lightwell {
namespace {

// Whether a texel of this alpha hits, in the floating point of Coverage's definition.
bool passes_mask(int texel, float factor, float cutoff) {
  return static_cast<float>(texel) / 255.0f * factor >= cutoff;
}

CoverageTest::Outcome outcome_of(bool least_hits, bool greatest_hits, CoverageTest::Outcome otherwise) {
  if (least_hits) return CoverageTest::Outcome::kAlwaysHit;
  return greatest_hits ? otherwise : CoverageTest::Outcome::kNeverHit;
}

std::uint32_t min_hitting_texel(float factor, float cutoff) {
  int texel = 0;
  while (texel < 256 && !passes_mask(texel, factor, cutoff)) ++texel;
  return static_cast<std::uint32_t>(texel);
}

// "Hash Functions for GPU Rendering", Jarzynski and Olano 2020: pcg4d, its first word.
std::uint32_t hash(std::uint32_t x, std::uint32_t y, std::uint32_t z, std::uint32_t w) {
  const auto step = [](std::uint32_t a) { return a * 1664525u + 1013904223u; };
  x = step(x), y = step(y), z = step(z), w = step(w);
  x += y * w, y += z * x, z += x * y, w += y * z;
  x ^= x >> 16, y ^= y >> 16, z ^= z >> 16, w ^= w >> 16;
  return x + y * w;
}

}  // namespace

AlphaRanges::Range AlphaRanges::of(const std::shared_ptr<const Image>& image) {
  const auto [entry, is_new] = ranges_.try_emplace(image.get());
  if (is_new) {
    Range range{255, 0};
    for (std::size_t i = 3; i < image->rgba.size(); i += 4) {
      range.least = std::min(range.least, image->rgba[i]);
      range.greatest = std::max(range.greatest, image->rgba[i]);
    }
    entry->second = {image, range};
  }
  return entry->second.range;
}

void AlphaRanges::drop_unused() {
  std::erase_if(ranges_, [](const auto& entry) { return entry.second.image.use_count() == 1; });
}

CoverageTest prepare_coverage(const Coverage& coverage, const Primitive& primitive, AlphaRanges& ranges) {
  using Outcome = CoverageTest::Outcome;
  CoverageTest test;
  if (coverage.mode == AlphaMode::kOpaque) return test;

  const auto& uvs = coverage.use.uv_set == 0 ? primitive.uv0 : primitive.uv1;
  AlphaRanges::Range range;
  if (coverage.image && !coverage.image->rgba.empty() && !uvs.empty()) {
    test.image = coverage.image.get();
    range = ranges.of(coverage.image);
  }
  if (coverage.mode == AlphaMode::kMask) {
    test.min_texel = min_hitting_texel(coverage.factor, coverage.cutoff);
    test.outcome = outcome_of(range.least >= test.min_texel, range.greatest >= test.min_texel, Outcome::kMask);
  } else {
    const float factor = coverage.factor > 0.0f ? std::min(coverage.factor, 1.0f) : 0.0f;
    test.blend_factor = static_cast<std::uint32_t>(std::lround(factor * 65536.0f));
    test.outcome = outcome_of(range.least == 255 && test.blend_factor == 65536u,
                              range.greatest > 0 && test.blend_factor > 0u, Outcome::kBlend);
  }
  // The rotation's sense is the one of Khronos' sample viewer: counter-clockwise as seen, with v pointing down.
  const TextureUse& use = coverage.use;
  const float c = std::cos(use.rotation), s = std::sin(use.rotation);
  test.uv_set = use.uv_set;
  test.u_row = {c * use.scale.x, s * use.scale.y, use.offset.x};
  test.v_row = {-s * use.scale.x, c * use.scale.y, use.offset.y};
  test.wrap_s = coverage.wrap_s;
  test.wrap_t = coverage.wrap_t;
  return test;
}

int nearest_texel(float coordinate, int size_px, Wrap wrap) {
  constexpr float kLimit = 1073741824.0f;  // 2^30: an int holds it, and the mirrored period of any image
  float x = std::floor(coordinate * static_cast<float>(size_px));
  x = x > -kLimit ? x : -kLimit;  // NaN too
  x = x < kLimit ? x : kLimit;
  const int texel = static_cast<int>(x);
  if (wrap == Wrap::kClampToEdge) return std::clamp(texel, 0, size_px - 1);
  const int period = wrap == Wrap::kRepeat ? size_px : 2 * size_px;
  const int wrapped = texel >= 0 ? texel % period : period - 1 - (-1 - texel) % period;
  return wrapped < size_px ? wrapped : period - 1 - wrapped;
}

std::uint32_t coverage_threshold(std::uint32_t instance, std::uint32_t triangle, float u, float v) {
  const auto cell = [](float x) { return static_cast<std::uint32_t>(std::clamp(x, 0.0f, 1.0f) * 4096.0f); };
  return hash(instance, triangle, cell(u), cell(v)) >> 8;
}

bool is_covered(const CoverageTest& test, const Primitive& primitive, std::uint32_t instance, std::uint32_t triangle,
                float u, float v) {
  using Outcome = CoverageTest::Outcome;
  if (test.outcome == Outcome::kAlwaysHit) return true;
  if (test.outcome == Outcome::kNeverHit) return false;
  std::uint32_t texel = 255;
  if (test.image) {
    const auto& uvs = test.uv_set == 0 ? primitive.uv0 : primitive.uv1;
    const std::uint32_t* corner = &primitive.indices[3 * static_cast<std::size_t>(triangle)];
    const glm::vec2 uv = (1.0f - u - v) * uvs[corner[0]] + u * uvs[corner[1]] + v * uvs[corner[2]];
    const glm::ivec2 size_px = test.image->size_px;
    const int x = nearest_texel(test.u_row.x * uv.x + test.u_row.y * uv.y + test.u_row.z, size_px.x, test.wrap_s);
    const int y = nearest_texel(test.v_row.x * uv.x + test.v_row.y * uv.y + test.v_row.z, size_px.y, test.wrap_t);
    texel =
        test.image->rgba
            [(static_cast<std::size_t>(y) * static_cast<std::size_t>(size_px.x) + static_cast<std::size_t>(x)) * 4 + 3];
  }
  if (test.outcome == Outcome::kMask) return texel >= test.min_texel;
  // texel / 255 * blend_factor / 2^16 > threshold / 2^24, both sides below 2^32.
  return ((texel * test.blend_factor) << 8) > coverage_threshold(instance, triangle, u, v) * 255u;
}

}  // namespace lightwell
