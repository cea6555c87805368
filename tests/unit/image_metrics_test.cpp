// The meter against values worked out by hand, from the papers' formulas, or by the authors' own implementation.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "renderer/image_metrics/compare.h"
#include "renderer/image_metrics/convolve.h"
#include "renderer/image_metrics/display.h"
#include "renderer/image_metrics/flip_color.h"
#include "renderer/image_metrics/heatmap.h"
#include "renderer/image_metrics/structural_similarity.h"

namespace lightwell::metrics {
namespace {

using ::testing::HasSubstr;

enum class Kind { kDisplay, kScene };

Picture make_picture(int width, int height, Kind kind, const std::function<double(int x, int y, int channel)>& value) {
  Picture picture{width, height, {}, kind == Kind::kDisplay};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int channel = 0; channel < 3; ++channel) picture.rgb.push_back(static_cast<float>(value(x, y, channel)));
  return picture;
}

Picture constant(double value, Kind kind = Kind::kDisplay, int width = 32, int height = 24) {
  return make_picture(width, height, kind, [=](int, int, int) { return value; });
}

// Two pictures with edges, colours and small dots, shared by several tests.
double checks(int x, int y, int channel) {
  return (x / 8 + y / 8) % 2 ? 0.9 - 0.2 * channel : 0.1 + 0.1 * channel;
}
double ramp(int x, int y, int channel) {
  return (x + 0.5 * channel * y) / 128.0;
}
double dotted_ramp(int x, int y, int channel) {
  return std::min(1.0, ramp(x, y, channel) + ((x * 7 + y * 13) % 11 == 0 ? 0.3 : 0.0));
}

TEST(LinearErrors, RelativeErrorByHand) {
  // The mean of the reference is 2, so it counts as 0.5 and 1.5, and the picture as 1 and 1.5.
  const Picture reference = make_picture(2, 1, Kind::kScene, [](int x, int, int) { return x == 0 ? 1.0 : 3.0; });
  const Picture test = make_picture(2, 1, Kind::kScene, [](int x, int, int) { return x == 0 ? 2.0 : 3.0; });
  const LinearErrors errors = linear_errors(test, reference);
  EXPECT_NEAR(errors.rel_mse, 0.5 * (0.25 / (0.25 + 0.01)), 1e-12);
  EXPECT_NEAR(errors.mse, 0.5, 1e-12);
  EXPECT_NEAR(errors.mean_signed_error[1], 0.5, 1e-12);
  EXPECT_NEAR(errors.reference_mean[2], 2.0, 1e-12);
  EXPECT_EQ(errors.rel_mse_trimmed, 0.0) << "the only wrong pixel is the worst 0.1 %";
}

TEST(LinearErrors, ScaleOfTheLightDoesNotMatter) {
  const Picture reference = make_picture(64, 48, Kind::kScene, ramp);
  const Picture test = make_picture(64, 48, Kind::kScene, dotted_ramp);
  Picture bright_reference = reference, bright_test = test;
  for (float& value : bright_reference.rgb) value *= 1024.0f;
  for (float& value : bright_test.rgb) value *= 1024.0f;
  EXPECT_NEAR(linear_errors(bright_test, bright_reference).rel_mse, linear_errors(test, reference).rel_mse, 1e-9);
}

TEST(LinearErrors, OneFireflyInAThousandIsTrimmed) {
  const Picture reference = constant(1.0, Kind::kScene, 50, 20);
  Picture test = constant(1.1, Kind::kScene, 50, 20);
  test.rgb[3 * 123] = test.rgb[3 * 123 + 1] = test.rgb[3 * 123 + 2] = 1001.0f;
  const LinearErrors errors = linear_errors(test, reference);
  EXPECT_NEAR(errors.rel_mse_trimmed, 0.01 / 1.01, 1e-7);
  EXPECT_NEAR(errors.rel_mse, (999 * 0.01 + 1e6) / 1.01 / 1000, 1e-2);
}

TEST(LinearErrors, SignTellsTooBrightFromTooDark) {
  const Picture reference = constant(0.5, Kind::kScene);
  const Picture test =
      make_picture(32, 24, Kind::kScene, [](int, int, int channel) { return 0.5 + 0.25 * (channel - 1); });
  EXPECT_THAT(linear_errors(test, reference).mean_signed_error,
              ::testing::ElementsAre(::testing::DoubleNear(-0.25, 1e-9), ::testing::DoubleNear(0.0, 1e-9),
                                     ::testing::DoubleNear(0.25, 1e-9)));
}

TEST(LinearErrors, AReferenceWithoutLightKeepsItsScale) {
  EXPECT_NEAR(linear_errors(constant(0.1, Kind::kScene), constant(0.0, Kind::kScene)).rel_mse, 1.0, 1e-6);
}

TEST(Display, SrgbCurveIsTheStandards) {
  EXPECT_NEAR(srgb_from_linear(0.5), 0.735356983052449, 1e-12);
  EXPECT_NEAR(srgb_from_linear(0.001), 0.01292, 1e-12);
  EXPECT_NEAR(srgb_from_linear(7.0), 1.0, 1e-12);
  for (const double value : {0.0, 0.002, 0.04045, 0.2, 0.7, 1.0})
    EXPECT_NEAR(srgb_from_linear(linear_from_srgb(value)), value, 1e-6);
}

TEST(Display, NeutralToneMapKeepsBaseColours) {
  // Between 0.08 and 0.8 only the 0.04 of a dielectric's reflection are taken off.
  const auto mapped = neutral_tone_map({0.1, 0.5, 0.79});
  EXPECT_NEAR(mapped[0], 0.06, 1e-12);
  EXPECT_NEAR(mapped[1], 0.46, 1e-12);
  EXPECT_NEAR(mapped[2], 0.75, 1e-12);
  EXPECT_EQ(neutral_tone_map({0.0, 0.0, 0.0}), (std::array<double, 3>{}));
  EXPECT_NEAR(neutral_tone_map({0.04, 0.04, 0.04})[0], 0.01, 1e-12) << "x^2 / 0.16 below 0.08";
}

TEST(Display, NeutralToneMapRisesAndStaysBelowOne) {
  double last = -1.0;
  for (double light = 0.0; light < 1e4; light = light * 1.2 + 0.01) {
    const double shown = neutral_tone_map({light, light, light})[0];
    EXPECT_GE(shown, last);
    EXPECT_LT(shown, 1.0);
    last = shown;
  }
  EXPECT_GT(last, 0.99);
}

TEST(Display, ExposureBringsTheMeanToMiddleGrey) {
  EXPECT_NEAR(exposure_of(constant(9.0, Kind::kScene)), 0.02, 1e-9);
  EXPECT_EQ(exposure_of(constant(0.0, Kind::kScene)), 1.0);
  EXPECT_EQ(exposure_of(constant(0.3, Kind::kDisplay)), 1.0);
}

TEST(Compare, PeakSignalToNoiseByHand) {
  // Encoded 0.5 against 0.6: a mean square of 0.01, which is 20 dB.
  const auto result = compare(constant(linear_from_srgb(0.6)), constant(linear_from_srgb(0.5)));
  ASSERT_TRUE(result);
  EXPECT_NEAR(result->psnr_db, 20.0, 1e-4);
  EXPECT_FALSE(result->hdr_flip.has_value()) << "display-referred pictures have no other exposures";
}

TEST(Compare, EqualPicturesHaveNoError) {
  const Picture picture = make_picture(40, 30, Kind::kScene, checks);
  const auto result = compare(picture, picture);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->linear.rel_mse, 0.0);
  EXPECT_EQ(result->linear.mse, 0.0);
  EXPECT_EQ(result->psnr_db, std::numeric_limits<double>::infinity());
  EXPECT_NEAR(result->ssim.value(), 1.0, 1e-9);
  EXPECT_EQ(result->flip, 0.0);
  EXPECT_EQ(result->hdr_flip.value(), 0.0);
}

TEST(Compare, RefusesWhatCannotBeCompared) {
  const auto other_size = compare(constant(1.0, Kind::kScene, 4, 5), constant(1.0, Kind::kScene, 5, 4));
  ASSERT_FALSE(other_size);
  EXPECT_EQ(other_size.error().kind, ErrorKind::kInvalidInput);
  EXPECT_THAT(other_size.error().message(), HasSubstr("4x5"));
  EXPECT_THAT(other_size.error().message(), HasSubstr("5x4"));

  Picture broken = constant(1.0, Kind::kScene, 4, 5);
  broken.rgb[3 * 9 + 2] = std::numeric_limits<float>::quiet_NaN();
  const auto not_finite = compare(constant(1.0, Kind::kScene, 4, 5), broken);
  ASSERT_FALSE(not_finite);
  EXPECT_THAT(not_finite.error().message(), HasSubstr("the reference"));
  EXPECT_THAT(not_finite.error().message(), HasSubstr("pixel (1, 2), channel B"));

  EXPECT_FALSE(compare(constant(1.0, Kind::kScene), constant(1.0, Kind::kDisplay)));
  EXPECT_FALSE(compare(Picture{}, Picture{}));
  Picture short_of_values = constant(1.0);
  short_of_values.rgb.pop_back();
  EXPECT_FALSE(compare(constant(1.0), short_of_values));
}

TEST(StructuralSimilarity, ConstantPicturesByHand) {
  // Without variance only the luminance term is left: (2 x y + C1) / (x^2 + y^2 + C1).
  const auto ssim = structural_similarity(constant(linear_from_srgb(0.5)), constant(linear_from_srgb(0.25)));
  EXPECT_NEAR(ssim.value(), (2 * 0.5 * 0.25 + 1e-4) / (0.25 + 0.0625 + 1e-4), 1e-5);
}

TEST(StructuralSimilarity, OneWindowWithoutShortCuts) {
  const Picture test = make_picture(11, 11, Kind::kDisplay, dotted_ramp);
  const Picture reference = make_picture(11, 11, Kind::kDisplay, checks);
  const auto luma = [](const Picture& picture, int x, int y) {
    const float* rgb = &picture.rgb[static_cast<std::size_t>(3 * (y * 11 + x))];
    return 0.299 * srgb_from_linear(rgb[0]) + 0.587 * srgb_from_linear(rgb[1]) + 0.114 * srgb_from_linear(rgb[2]);
  };
  double total = 0, mean_x = 0, mean_y = 0, variance_x = 0, variance_y = 0, covariance = 0;
  const auto for_each = [&](const std::function<void(double weight, double x, double y)>& use) {
    for (int v = 0; v < 11; ++v)
      for (int u = 0; u < 11; ++u)
        use(std::exp(-((u - 5) * (u - 5) + (v - 5) * (v - 5)) / 4.5), luma(test, u, v), luma(reference, u, v));
  };
  for_each([&](double weight, double, double) { total += weight; });
  for_each([&](double weight, double x, double y) { mean_x += weight / total * x, mean_y += weight / total * y; });
  for_each([&](double weight, double x, double y) {
    variance_x += weight / total * (x - mean_x) * (x - mean_x);
    variance_y += weight / total * (y - mean_y) * (y - mean_y);
    covariance += weight / total * (x - mean_x) * (y - mean_y);
  });
  const double expected = (2 * mean_x * mean_y + 1e-4) * (2 * covariance + 9e-4) /
                          ((mean_x * mean_x + mean_y * mean_y + 1e-4) * (variance_x + variance_y + 9e-4));
  EXPECT_NEAR(structural_similarity(test, reference).value(), expected, 1e-5);
}

TEST(StructuralSimilarity, NeedsAWholeWindow) {
  EXPECT_FALSE(structural_similarity(constant(1, Kind::kDisplay, 10, 40), constant(1, Kind::kDisplay, 10, 40)));
}

TEST(Convolve, RepeatsTheBorder) {
  Plane plane(3, 1);
  plane.values = {1.0f, 2.0f, 4.0f};
  const std::vector<float> row = {1.0f, 0.0f, 10.0f}, none = {1.0f};
  EXPECT_THAT(convolve(plane, row, none).values, ::testing::ElementsAre(21.0f, 41.0f, 42.0f));
}

TEST(FlipColor, SpacesRoundTrip) {
  for (const Color& color : {Color{1, 0, 0}, Color{0, 1, 0}, Color{0, 0, 1}, Color{0.2, 0.5, 0.9}}) {
    const Color back = linear_from_ycxcz(ycxcz_from_linear(color));
    for (std::size_t channel = 0; channel < 3; ++channel) EXPECT_NEAR(back[channel], color[channel], 1e-6);
  }
  EXPECT_NEAR(hunt_lab_from_linear({1, 1, 1})[0], 100.0, 1e-9);
}

TEST(LdrFlip, BlackAgainstWhiteByTheFormula) {
  // No feature, and HyAB is the lightness 100. The greatest HyAB, green against blue, is 203.3 after Hunt's adjustment.
  const double greatest = std::pow(hyab(hunt_lab_from_linear({0, 1, 0}), hunt_lab_from_linear({0, 0, 1})), 0.7);
  EXPECT_NEAR(std::pow(greatest, 1 / 0.7), 203.3, 0.1);
  const double expected = 0.95 + 0.05 * (std::pow(100.0, 0.7) - 0.4 * greatest) / (0.6 * greatest);
  EXPECT_NEAR(mean_of(ldr_flip(constant(1), constant(0))), expected, 1e-5);
  EXPECT_NEAR(expected, 0.9674, 5e-5);
}

TEST(LdrFlip, GreenAgainstBlueIsTheGreatest) {
  const auto primary = [](int wanted) {
    return make_picture(32, 24, Kind::kDisplay, [=](int, int, int channel) { return channel == wanted ? 1.0 : 0.0; });
  };
  EXPECT_NEAR(mean_of(ldr_flip(primary(1), primary(2))), 1.0, 1e-5);
}

TEST(LdrFlip, IsSymmetric) {
  const Picture a = make_picture(64, 48, Kind::kDisplay, dotted_ramp), b = make_picture(64, 48, Kind::kDisplay, ramp);
  EXPECT_EQ(ldr_flip(a, b).values, ldr_flip(b, a).values);
}

// The means that the authors' C++ implementation (version 1.7) gives on the same pictures.
TEST(LdrFlip, AgreesWithTheAuthorsImplementation) {
  const Picture shifted = make_picture(64, 48, Kind::kDisplay, [](int x, int y, int channel) {
    return ((x + 1) / 8 + y / 8) % 2 ? 0.9 - 0.2 * channel : 0.1 + 0.1 * channel;
  });
  EXPECT_NEAR(mean_of(ldr_flip(shifted, make_picture(64, 48, Kind::kDisplay, checks))), 0.236934, 1e-5);
  EXPECT_NEAR(
      mean_of(ldr_flip(make_picture(64, 48, Kind::kDisplay, dotted_ramp), make_picture(64, 48, Kind::kDisplay, ramp))),
      0.121299, 1e-5);
}

TEST(HdrFlip, AgreesWithTheAuthorsImplementation) {
  const auto light = [](int x, int y, int channel) {
    return 0.01 * std::exp((x + 2 * y) / 12.0) * (1 + 0.3 * channel);
  };
  const Picture reference = make_picture(64, 48, Kind::kScene, light);
  const Picture test = make_picture(64, 48, Kind::kScene, [&](int x, int y, int channel) {
    return light(x, y, channel) * ((x * 5 + y * 3) % 7 == 0 ? 1.2 : 1.0);
  });
  const ExposureRange range = exposure_range(reference);
  EXPECT_NEAR(range.start, -11.479101, 1e-4);
  EXPECT_NEAR(range.stop, -2.101583, 1e-4);
  EXPECT_EQ(range.count, 10);
  EXPECT_NEAR(mean_of(hdr_flip(test, reference, range)), 0.055081, 1e-5);
}

TEST(HdrFlip, ExposuresAreBoundedWithoutAMedian) {
  const ExposureRange dark = exposure_range(constant(0.0, Kind::kScene));
  EXPECT_EQ(dark.count, 1);
  Picture lamp = constant(0.0, Kind::kScene);
  lamp.rgb[0] = 1000.0f;
  EXPECT_EQ(exposure_range(lamp).count, 24);
  EXPECT_GT(mean_of(hdr_flip(constant(1.0, Kind::kScene), lamp, exposure_range(lamp))), 0.5);
}

TEST(HdrFlip, SeesWhatOneExposureHides) {
  // Both pictures are white to the LDR measure's exposure; a darker one tells them apart.
  const auto sun = [](double brightness) {
    return make_picture(48, 48, Kind::kScene,
                        [=](int x, int y, int) { return std::hypot(x - 24, y - 24) < 6.0 ? brightness : 0.1; });
  };
  const auto result = compare(sun(20000.0), sun(10000.0));
  ASSERT_TRUE(result);
  EXPECT_GT(result->hdr_flip.value(), result->flip);
}

TEST(Heatmap, GetsLighterEvenlyFromBlackToYellow) {
  EXPECT_EQ(heat_color(0.0), (std::array<std::uint8_t, 3>{0, 0, 0}));
  const auto top = heat_color(1.0);
  EXPECT_GT(top[0], 240);
  EXPECT_GT(top[1], 220);
  EXPECT_LT(top[2], top[1]);
  EXPECT_EQ(heat_color(std::nan("")), top);
  double last = -1.0;
  for (int i = 0; i <= 32; ++i) {
    const auto color = heat_color(i / 32.0);
    const double light = luminance(linear_from_srgb(color[0] / 255.0), linear_from_srgb(color[1] / 255.0),
                                   linear_from_srgb(color[2] / 255.0));
    EXPECT_GT(light, last) << "at " << i / 32.0;
    last = light;
  }
  Plane errors(2, 1);
  errors.values = {0.0f, 1.0f};
  EXPECT_EQ(heatmap(errors), (std::vector<std::uint8_t>{0, 0, 0, top[0], top[1], top[2]}));
}

}  // namespace
}  // namespace lightwell::metrics
