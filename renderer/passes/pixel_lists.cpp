#include "renderer/passes/pixel_lists.h"

#include <algorithm>
#include <cstring>

#include "renderer/passes/bindings.glsl"

namespace lightwell {

namespace {

constexpr std::uint32_t kUnmatchedPart =
    64;                                   // of the picture's pixels, one in so many may get rays for want of a match
constexpr float kSpareShare = 0.8f;       // of the room, should the next frame have more of them
constexpr std::uint32_t kListCounts = 3;  // reflecting, unmatched, of these the listed ones

}  // namespace

PixelLists::PixelLists()
    : counts_("counts of listed pixels", kListCounts * sizeof(std::uint32_t), gl::BufferUse::kHostVisible),
      reflecting_("reflecting pixels", 0),
      unmatched_("unmatched pixels", 0) {}

void PixelLists::resize(glm::ivec2 size_px) {
  const auto pixels = static_cast<std::uint32_t>(size_px.x) * static_cast<std::uint32_t>(size_px.y);
  most_unmatched_ = std::max(1u, pixels / kUnmatchedPart);
  reflecting_.reserve(pixels * sizeof(std::uint32_t));
  unmatched_.reserve(most_unmatched_ * sizeof(std::uint32_t));
}

void PixelLists::begin() {
  counts_.clear();
}

void PixelLists::bind() const {
  counts_.bind_storage(BINDING_PIXEL_COUNTS);
  reflecting_.bind_storage(BINDING_REFLECTING_PIXELS);
  unmatched_.bind_storage(BINDING_UNMATCHED_PIXELS);
}

void PixelLists::count() {
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT | GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT);
  gl::wait_for_device();
  std::uint32_t counts[kListCounts];
  std::memcpy(counts, counts_.host(), sizeof counts);
  reflecting_count_ = counts[0];
  // Which of too many found room is up to the order of threads: then none of them is taken.
  listed_count_ = counts[2] <= most_unmatched_ ? counts[2] : 0;
  unmatched_share_ =
      std::min(1.0f, kSpareShare * static_cast<float>(most_unmatched_) / static_cast<float>(std::max(1u, counts[1])));
}

}  // namespace lightwell
