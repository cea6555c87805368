// The account of what textures and buffers take of the device.
#include "renderer/gl/memory.h"

#include <gtest/gtest.h>

#include "renderer/gl/buffer.h"
#include "renderer/gl/device.h"
#include "renderer/gl/texture.h"

namespace lightwell::gl {
namespace {

TEST(DeviceMemory, IsThatOfTexturesAndBuffersWhileTheyLive) {
  const auto context = Context::create();
  const std::uint64_t before = device_memory().own_bytes;
  const auto taken = [before] { return device_memory().own_bytes - before; };
  {
    Texture halves("halves", GL_RGBA16F, {64, 32});
    EXPECT_EQ(taken(), 64u * 32u * 8u);
    const Texture depths("depths", GL_DEPTH_COMPONENT32F, {16, 16},
                         {.target = GL_TEXTURE_2D_ARRAY, .layers = 6, .levels = 2});
    EXPECT_EQ(taken(), 64u * 32u * 8u + (256u + 64u) * 4u * 6u);
    Texture other("other", GL_R8, {8, 8});
    other = std::move(halves);
    EXPECT_EQ(taken(), 64u * 32u * 8u + (256u + 64u) * 4u * 6u);
    Buffer words("words", 1000);
    words.reserve(3000);
    EXPECT_EQ(taken(), 64u * 32u * 8u + (256u + 64u) * 4u * 6u + 3000u);
    const Buffer moved(std::move(words));
    EXPECT_EQ(taken(), 64u * 32u * 8u + (256u + 64u) * 4u * 6u + 3000u);
  }
  EXPECT_EQ(taken(), 0u);
}

TEST(DeviceMemory, IsNeverMoreThanThereIs) {
  const auto context = Context::create();
  const DeviceMemory memory = device_memory();
  EXPECT_LE(memory.used_bytes, memory.total_bytes);
}

}  // namespace
}  // namespace lightwell::gl
