// A frame that is given up at the end of any of its stages leaves nothing behind in the next one.
#include <gtest/gtest.h>

#include "tests/image/film.h"

namespace lightwell::testing {
namespace {

/// A film's frame, given up when it has been asked about for the n-th time; false: it was finished before.
bool give_up(Film& film, const Scene& scene, int question) {
  int asked = 0;
  film.request().is_unwanted = [&] { return ++asked == question; };
  const bool given_up = film.is_given_up(scene);
  film.request().is_unwanted = nullptr;
  return given_up;
}

void expect_no_trace(const Settings& settings, int least_stages) {
  const Scene scene = varied_room();
  const glm::ivec2 size_px(32, 24);
  Film film(before_varied_room(), settings, size_px);
  const Pixels undisturbed = film.next(scene);
  int stages = 0;
  while (give_up(film, scene, stages + 1)) {
    ++stages;
    EXPECT_EQ(film.next(scene).rgb, undisturbed.rgb) << "after stage " << stages;
  }
  EXPECT_GE(stages, least_stages);
}

TEST(GivenUp, ThesisLeavesNothingBehind) {
  Settings settings;
  settings.samples = 8;
  settings.bounces = 2;
  settings.indirect_size = 16;
  settings.denoise = true;
  for (const int patch : {1, 2}) {
    settings.patch = patch;
    expect_no_trace(settings, 8);
  }
}

TEST(GivenUp, ReferenceLeavesNothingBehind) {
  expect_no_trace(reference_settings(3), 8);
}

TEST(GivenUp, AnAccumulationBeginsAnew) {
  const Scene scene = varied_room();
  Film film(before_varied_room(), reference_settings(3), {32, 24});
  const Pixels first = film.next(scene);
  film.request().accumulate = true;
  film.next(scene);
  EXPECT_TRUE(give_up(film, scene, 3));
  EXPECT_EQ(film.next(scene).rgb, first.rgb);
}

TEST(GivenUp, RealtimeIsAlwaysFinished) {
  const Scene scene = varied_room();
  Film film(before_varied_room(), realtime_settings(2));
  EXPECT_FALSE(give_up(film, scene, 1));
}

}  // namespace
}  // namespace lightwell::testing
