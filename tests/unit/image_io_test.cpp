// Pictures in and out: every kind of PNG and JPEG that glTF may hold, broken ones, and what is written read again.
#include "renderer/image_io/image_io.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string_view>

#include "tests/unit/png_writer.h"

namespace lightwell {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::uint64_t kManyPixels = 1u << 20;

// 2 x 1 pixels, quality 50, each of one colour: grey 100, the ink of pure red, and a progressive (202, 40, 38).
constexpr std::string_view kGreyJpeg =
    "ffd8ffdb004300100b0c0e0c0a100e0d0e1211101318281a181616183123251d283a333d3c3933383740485c4e4044574537"
    "38506d51575f626768673e4d71797064785c656763ffc0000b080001000201011100ffc40014000100000000000000000000"
    "000000000004ffc40014100100000000000000000000000000000000ffda0008010100003f000bffd9";
constexpr std::string_view kCmykJpeg =
    "ffd8ffee000e41646f626500640000000000ffdb004300100b0c0e0c0a100e0d0e1211101318281a181616183123251d283a"
    "333d3c3933383740485c4e404457453738506d51575f626768673e4d71797064785c656763ffc00014080001000204431100"
    "4d11005911004b1100ffc40014000100000000000000000000000000000007ffc40014100100000000000000000000000000"
    "000000ffda000e0443004d0059004b00003f00401f8fc80fffd9";
constexpr std::string_view kProgressiveJpeg =
    "ffd8ffdb004300100b0c0e0c0a100e0d0e1211101318281a181616183123251d283a333d3c3933383740485c4e4044574537"
    "38506d51575f626768673e4d71797064785c656763ffdb0043011112121815182f1a1a2f6342384263636363636363636363"
    "63636363636363636363636363636363636363636363636363636363636363636363636363636363ffc20011080001000203"
    "012200021101031101ffc4001500010100000000000000000000000000000004ffc400150101010000000000000000000000"
    "0000000305ffda000c0301000210031000000194053fffc40014100100000000000000000000000000000000ffda00080101"
    "000105027fffc40014110100000000000000000000000000000000ffda0008010301013f017fffc400141101000000000000"
    "00000000000000000000ffda0008010201013f017fffc40014100100000000000000000000000000000000ffda0008010100"
    "063f027fffc40014100100000000000000000000000000000000ffda0008010100013f217fffda000c030100020003000000"
    "100bffc40014110100000000000000000000000000000000ffda0008010301013f107fffc400141101000000000000000000"
    "00000000000000ffda0008010201013f107fffc40014100100000000000000000000000000000000ffda0008010100013f10"
    "7fffd9";

ByteVector from_hex(std::string_view hex) {
  const auto digit = [](char c) { return c <= '9' ? c - '0' : c - 'a' + 10; };
  ByteVector bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
    bytes.push_back(static_cast<std::byte>(digit(hex[i]) * 16 + digit(hex[i + 1])));
  return bytes;
}

std::vector<int> decoded(const ByteVector& bytes) {
  const Result<Image> image = decode_image(bytes, kManyPixels);
  if (!image) {
    ADD_FAILURE() << image.error().message();
    return {};
  }
  EXPECT_EQ(image->rgba.size(), static_cast<std::size_t>(image->size_px.x * image->size_px.y * 4));
  return {image->rgba.begin(), image->rgba.end()};
}

Error decode_error(const ByteVector& bytes, std::uint64_t max_pixels = kManyPixels) {
  const Result<Image> image = decode_image(bytes, max_pixels);
  EXPECT_FALSE(image.ok());
  return image ? Error{} : image.error();
}

std::filesystem::path temporary(const std::string& name) {
  return std::filesystem::path(testing::TempDir()) / ("lightwell_image_io_" + name);
}

TEST(DecodeImage, RgbGetsAnOpaqueAlpha) {
  EXPECT_THAT(decoded(make_png({.width = 2, .samples = {1, 2, 3, 4, 5, 6}})), ElementsAre(1, 2, 3, 255, 4, 5, 6, 255));
}

TEST(DecodeImage, AlphaStaysStraight) {
  EXPECT_THAT(decoded(one_pixel_png({200, 100, 50, 10})), ElementsAre(200, 100, 50, 10));
}

TEST(DecodeImage, GreyIsSpread) {
  EXPECT_THAT(decoded(make_png({.color = PngColor::kGrey, .samples = {77}})), ElementsAre(77, 77, 77, 255));
}

TEST(DecodeImage, GreyWithAlphaIsSpread) {
  EXPECT_THAT(decoded(make_png({.color = PngColor::kGreyAlpha, .samples = {77, 12}})), ElementsAre(77, 77, 77, 12));
}

TEST(DecodeImage, OneBitGrey) {
  EXPECT_THAT(decoded(make_png({.width = 2, .color = PngColor::kGrey, .bit_depth = 1, .samples = {0x40}})),
              ElementsAre(0, 0, 0, 255, 255, 255, 255, 255));
}

TEST(DecodeImage, SixteenBitsBecomeEight) {
  // 0x8080 / 65535 * 255 = 128; 0x00ff / 65535 * 255 = 0.99
  EXPECT_THAT(decoded(make_png({.bit_depth = 16, .samples = {0x80, 0x80, 0x00, 0xff, 0xff, 0xff}})),
              ElementsAre(128, 1, 255, 255));
}

TEST(DecodeImage, PaletteWithTransparency) {
  EXPECT_THAT(decoded(make_png({.width = 2,
                                .color = PngColor::kPalette,
                                .samples = {1, 0},
                                .palette = {10, 20, 30, 40, 50, 60},
                                .transparency = {255, 128}})),
              ElementsAre(40, 50, 60, 128, 10, 20, 30, 255));
}

TEST(DecodeImage, GreyJpeg) {
  EXPECT_THAT(decoded(from_hex(kGreyJpeg)), ElementsAre(100, 100, 100, 255, 100, 100, 100, 255));
}

TEST(DecodeImage, CmykJpegBecomesRgb) {
  EXPECT_THAT(decoded(from_hex(kCmykJpeg)), ElementsAre(255, 0, 0, 255, 255, 0, 0, 255));
}

TEST(DecodeImage, ProgressiveJpeg) {
  EXPECT_THAT(decoded(from_hex(kProgressiveJpeg)), ElementsAre(202, 40, 38, 255, 202, 40, 38, 255));
}

TEST(DecodeImage, EveryTruncationIsAnError) {
  for (const ByteVector& whole : {one_pixel_png(), from_hex(kGreyJpeg), from_hex(kProgressiveJpeg)}) {
    // A PNG without its last, empty chunk has all its pixels; nothing is lost if a decoder accepts it.
    const std::size_t ends = whole[1] == std::byte{'P'} ? whole.size() - 16 : whole.size();
    for (std::size_t length = 0; length < ends; ++length) {
      const ByteVector part(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length));
      EXPECT_FALSE(decode_image(part, kManyPixels).ok()) << length << " of " << whole.size() << " bytes";
    }
  }
}

TEST(DecodeImage, HugeSizesAreRefusedUnseen) {
  ByteVector png = one_pixel_png();
  for (const std::size_t offset : {16, 20}) png[offset] = std::byte{0x7f};
  const Error error = decode_error(png);
  EXPECT_EQ(error.kind, ErrorKind::kTooLarge);
  EXPECT_THAT(error.what, HasSubstr("2130706433 x 2130706433"));

  ByteVector jpeg = from_hex(kProgressiveJpeg);
  const ByteVector frame_marker{std::byte{0xff}, std::byte{0xc2}};
  const auto frame = std::search(jpeg.begin(), jpeg.end(), frame_marker.begin(), frame_marker.end());
  ASSERT_NE(frame, jpeg.end());
  for (std::ptrdiff_t i = 5; i < 9; ++i) frame[i] = std::byte{0xff};
  EXPECT_EQ(decode_error(jpeg).kind, ErrorKind::kTooLarge);
}

TEST(DecodeImage, NegativeAndEmptySizesAreRefused) {
  ByteVector png = one_pixel_png();
  png[16] = std::byte{0xff};
  EXPECT_EQ(decode_error(png).kind, ErrorKind::kInvalidInput);
  EXPECT_EQ(decode_error(make_png({.width = 0, .samples = {}})).kind, ErrorKind::kInvalidInput);
}

TEST(DecodeImage, TheLimitIsExact) {
  const ByteVector png = make_png({.width = 2, .samples = {1, 2, 3, 4, 5, 6}});
  EXPECT_TRUE(decode_image(png, 2).ok());
  EXPECT_EQ(decode_error(png, 1).kind, ErrorKind::kTooLarge);
}

TEST(DecodeImage, OtherFormatsAreUnsupported) {
  EXPECT_EQ(decode_error(to_bytes({'G', 'I', 'F', '8', '9', 'a', 1, 0, 1, 0})).kind, ErrorKind::kUnsupported);
  EXPECT_EQ(decode_error({}).kind, ErrorKind::kUnsupported);
}

TEST(DecodeImage, DamagedPixelsAreAnError) {
  ByteVector png = one_pixel_png();
  png[45] ^= std::byte{0xff};  // within the compressed data
  EXPECT_EQ(decode_error(png).kind, ErrorKind::kInvalidInput);
}

FloatImage gradient(int channels) {
  FloatImage image;
  image.size_px = {3, 2};
  image.channels = channels;
  for (int i = 0; i < 6 * channels; ++i) image.pixels.push_back(0.125f * static_cast<float>(i));
  return image;
}

TEST(WriteExr, FloatsComeBackBitForBit) {
  for (const int channels : {3, 4}) {
    FloatImage image = gradient(channels);
    image.pixels[1] = 12345.678f;
    image.pixels[2] = -1e-20f;
    const auto path = temporary("floats.exr");
    ASSERT_TRUE(write_exr(path, image).ok());
    const Result<FloatImage> again = read_image(path);
    ASSERT_TRUE(again.ok()) << again.error().message();
    EXPECT_EQ(again->size_px, image.size_px);
    EXPECT_EQ(again->channels, channels);
    EXPECT_EQ(again->pixels, image.pixels);
  }
}

TEST(WriteExr, HalvesKeepWhatHalvesCan) {
  const FloatImage image = gradient(3);  // eighths below 3: exact in half floats
  const auto path = temporary("halves.exr");
  ASSERT_TRUE(write_exr(path, image, {}, false).ok());
  const Result<FloatImage> again = read_image(path);
  ASSERT_TRUE(again.ok());
  EXPECT_EQ(again->pixels, image.pixels);
  EXPECT_LT(encode_exr(image, {}, false)->size(), encode_exr(image, {}, true)->size());
}

TEST(WriteExr, NotANumberSurvives) {
  FloatImage image = gradient(3);
  image.pixels[4] = std::numeric_limits<float>::quiet_NaN();
  image.pixels[5] = std::numeric_limits<float>::infinity();
  const auto path = temporary("nan.exr");
  ASSERT_TRUE(write_exr(path, image).ok());
  const Result<FloatImage> again = read_image(path);
  ASSERT_TRUE(again.ok());
  EXPECT_TRUE(std::isnan(again->pixels[4]));
  EXPECT_TRUE(std::isinf(again->pixels[5]));
}

TEST(WriteExr, MetadataIsInTheHeaderAndTheTimeIsNot) {
  const Result<std::vector<std::byte>> encoded = encode_exr(gradient(3), {{"lightwell:seed", "4711"}});
  ASSERT_TRUE(encoded.ok());
  const std::string_view text(reinterpret_cast<const char*>(encoded->data()), encoded->size());
  EXPECT_THAT(text, HasSubstr("lightwell:seed"));
  EXPECT_THAT(text, HasSubstr("4711"));
  EXPECT_THAT(text, HasSubstr("1970:01:01 00:00:00"));
}

TEST(WriteLdr, PngComesBackExactly) {
  const std::vector<std::uint8_t> rgb{0, 128, 255, 10, 20, 30};
  const auto path = temporary("exact.PNG");
  ASSERT_TRUE(write_ldr(path, {2, 1}, rgb).ok());
  const Result<FloatImage> again = read_image(path);
  ASSERT_TRUE(again.ok()) << again.error().message();
  EXPECT_EQ(again->channels, 3);
  EXPECT_FLOAT_EQ(again->pixels[0], 0.0f);
  EXPECT_NEAR(again->pixels[1], 0.2158605f, 1e-6f);  // sRGB 128
  EXPECT_FLOAT_EQ(again->pixels[2], 1.0f);
  EXPECT_NEAR(again->pixels[3], 0.0030353f, 1e-6f);  // sRGB 10, the straight part of the curve
  EXPECT_THAT(decoded(*encode_ldr("png", {2, 1}, rgb)), ElementsAre(0, 128, 255, 255, 10, 20, 30, 255));
}

TEST(WriteLdr, JpegIsNear) {
  const std::vector<std::uint8_t> rgb(16 * 16 * 3, 90);
  const std::vector<int> again = decoded(*encode_ldr("jpg", {16, 16}, rgb));
  ASSERT_EQ(again.size(), 16u * 16 * 4);
  EXPECT_NEAR(again[0], 90, 2);
  EXPECT_LT(encode_ldr("jpg", {16, 16}, rgb, 1)->size(), encode_ldr("png", {16, 16}, rgb)->size() + 16 * 16 * 3);
}

TEST(WriteLdr, MistakesAreNamed) {
  const std::vector<std::uint8_t> rgb(3);
  EXPECT_EQ(write_ldr(temporary("x.gif"), {1, 1}, rgb).error().kind, ErrorKind::kUnsupported);
  EXPECT_EQ(write_ldr(temporary("x.png"), {2, 1}, rgb).error().kind, ErrorKind::kInvalidInput);
  EXPECT_EQ(write_ldr(temporary("x.png"), {-1, -1}, rgb).error().kind, ErrorKind::kInvalidInput);
  EXPECT_THAT(write_ldr("/no/such/folder/x.png", {1, 1}, rgb).error().message(), HasSubstr("No such file"));
  EXPECT_EQ(write_exr(temporary("x.exr"), FloatImage{{1, 1}, 2, {0, 0}}).error().kind, ErrorKind::kInvalidInput);
}

TEST(ReadImage, MistakesAreNamed) {
  EXPECT_EQ(read_image(temporary("missing.exr")).error().kind, ErrorKind::kNotFound);
  EXPECT_EQ(read_image(testing::TempDir()).error().kind, ErrorKind::kInvalidInput);
  ASSERT_TRUE(write_ldr(temporary("broken.png"), {1, 1}, std::vector<std::uint8_t>(3)).ok());
  std::filesystem::resize_file(temporary("broken.png"), 40);
  const Result<FloatImage> broken = read_image(temporary("broken.png"));
  ASSERT_FALSE(broken.ok());
  EXPECT_EQ(broken.error().kind, ErrorKind::kInvalidInput);
  EXPECT_THAT(broken.error().where, HasSubstr("broken.png"));
}

}  // namespace
}  // namespace lightwell
