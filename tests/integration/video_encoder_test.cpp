// The encoder by itself: colours, keys, sizes, quality; decoded by libavcodec.
#include "server/video/video_encoder.h"

#include "tests/integration/test_pictures.h"
#include "tests/integration/video_decoder.h"

namespace lightwell::test {
namespace {

using Rgbx = std::vector<std::uint8_t>;
using Colour = std::array<std::uint8_t, 3>;

template <class ColourAt>
Rgbx paint(glm::ivec2 size_px, const ColourAt& colour_at) {
  Rgbx picture;
  for (int y = 0; y < size_px.y; ++y)
    for (int x = 0; x < size_px.x; ++x) {
      const Colour colour = colour_at(x, y);
      picture.insert(picture.end(), {colour[0], colour[1], colour[2], 255});
    }
  return picture;
}

TEST(VideoEncoder, ColoursComeBackAsTheyWereAndTheStreamSaysHowToReadThem) {
  constexpr std::array<Colour, 8> kColours{{{255, 255, 255},
                                            {0, 0, 0},
                                            {255, 0, 0},
                                            {0, 255, 0},
                                            {0, 0, 255},
                                            {191, 128, 64},
                                            {10, 60, 30},
                                            {128, 128, 128}}};
  const glm::ivec2 size_px(256, 32);
  const Rgbx picture = paint(size_px, [&](int x, int) { return kColours[static_cast<std::size_t>(x / 32)]; });
  VideoEncoder encoder;
  const auto packet = encoder.encode(picture, size_px, 95, false);
  ASSERT_TRUE(packet);
  VideoDecoder decoder;
  const auto decoded = decoder.decode(*packet->bytes);
  ASSERT_TRUE(decoded);
  EXPECT_EQ(decoded->range, AVCOL_RANGE_MPEG);
  EXPECT_EQ(decoded->matrix, AVCOL_SPC_BT709);
  EXPECT_EQ(decoded->primaries, AVCOL_PRI_BT709);
  EXPECT_EQ(decoded->transfer, AVCOL_TRC_IEC61966_2_1);
  for (std::size_t i = 0; i < kColours.size(); ++i)
    for (std::size_t channel = 0; channel < 3; ++channel)
      EXPECT_NEAR(decoded->at(static_cast<int>(i) * 32 + 16, 16)[channel], kColours[i][channel], 3.0)
          << "colour " << i << ", channel " << channel;
}

TEST(VideoEncoder, PacketsAreCountedAndAKeyComesFirstAndWhenAskedFor) {
  VideoEncoder encoder;
  std::uint64_t index = 0;
  for (const bool want_key : {false, false, true, false}) {
    const auto packet = encoder.encode(moving_picture({64, 48}, static_cast<int>(index)), {64, 48}, 80, want_key);
    ASSERT_TRUE(packet);
    EXPECT_EQ(packet->index, ++index);
    EXPECT_EQ(packet->is_key, want_key || index == 1);
  }
}

TEST(VideoEncoder, WhoBeginsAtAnyKeySeesWhatOthersSee) {
  const glm::ivec2 size_px(160, 90);
  VideoEncoder encoder;
  VideoDecoder from_the_start, from_the_second_key;
  for (int i = 0; i < 12; ++i) {
    const auto packet = encoder.encode(moving_picture(size_px, i), size_px, 80, i == 5);
    ASSERT_TRUE(packet);
    const auto first = from_the_start.decode(*packet->bytes);
    ASSERT_TRUE(first) << "picture " << i;
    EXPECT_GT(psnr(*first, moving_picture(size_px, i)), 32.0);
    if (i < 5) continue;
    const auto second = from_the_second_key.decode(*packet->bytes);
    ASSERT_TRUE(second) << "picture " << i;
    EXPECT_EQ(second->rgb, first->rgb);
  }
}

TEST(VideoEncoder, AnotherSizeAndARestBeginWithAKey) {
  VideoEncoder encoder;
  VideoDecoder decoder;
  std::uint64_t index = 0;
  const auto encode = [&](glm::ivec2 size_px) {
    const auto packet = encoder.encode(moving_picture(size_px, 0), size_px, 80, false);
    EXPECT_TRUE(packet);
    EXPECT_EQ(packet->index, ++index);
    const auto decoded = decoder.decode(*packet->bytes);
    EXPECT_TRUE(decoded && decoded->width == size_px.x && decoded->height == size_px.y);
    return packet->is_key;
  };
  EXPECT_TRUE(encode({64, 48}));
  EXPECT_FALSE(encode({64, 48}));
  EXPECT_TRUE(encode({48, 64}));
  EXPECT_FALSE(encode({48, 64}));
  encoder.rest();
  EXPECT_TRUE(encode({48, 64}));
}

TEST(VideoEncoder, MoreQualityIsMoreBytesAndLessError) {
  const glm::ivec2 size_px(320, 180);
  std::size_t bytes = 0;
  double decibels = 0.0;
  for (const int quality : {20, 44, 80, 100}) {
    VideoEncoder encoder;
    VideoDecoder decoder;
    const auto packet = encoder.encode(moving_picture(size_px, 0), size_px, quality, false);
    ASSERT_TRUE(packet);
    const auto decoded = decoder.decode(*packet->bytes);
    ASSERT_TRUE(decoded);
    EXPECT_GT(packet->bytes->size(), bytes);
    EXPECT_GT(psnr(*decoded, moving_picture(size_px, 0)), decibels);
    bytes = packet->bytes->size();
    decibels = psnr(*decoded, moving_picture(size_px, 0));
  }
}

TEST(VideoEncoder, TakesWhatDecodersTake) {
  ASSERT_TRUE(can_encode_video());
  EXPECT_TRUE(VideoEncoder::takes({2, 2}));
  EXPECT_TRUE(VideoEncoder::takes({4096, 2304}));
  EXPECT_FALSE(VideoEncoder::takes({4096, 4096}));
  EXPECT_FALSE(VideoEncoder::takes({33, 32}));
  EXPECT_FALSE(VideoEncoder::takes({32, 33}));
  for (const glm::ivec2 size_px : {glm::ivec2(2, 2), glm::ivec2(16, 2), glm::ivec2(18, 4096)}) {
    VideoEncoder encoder;
    VideoDecoder decoder;
    const auto packet = encoder.encode(moving_picture(size_px, 0), size_px, 80, false);
    ASSERT_TRUE(packet);
    EXPECT_TRUE(decoder.decode(*packet->bytes)) << size_px.x << " x " << size_px.y;
  }
}

}  // namespace
}  // namespace lightwell::test
