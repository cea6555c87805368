// Streams of video: agreed to in the hello, decoded by libavcodec as a client would, and given up for JPEG.
#include "server/video/video_encoder.h"
#include "tests/integration/server_fixture.h"
#include "tests/integration/video_decoder.h"

#include <numeric>

namespace lightwell::test {
namespace {

using protocol::FrameCodec;

constexpr double kGrey = 51.0;  // of 255, what FakeSource paints

/// The mean of what a packet shows; none if it does not decode, or is not of that size.
std::optional<double> mean_of(VideoDecoder& decoder, const Heard& heard) {
  const auto picture = decoder.decode(heard.payload);
  if (!picture || picture->width != heard.frame->width || picture->height != heard.frame->height) return {};
  return std::accumulate(picture->rgb.begin(), picture->rgb.end(), 0.0) / static_cast<double>(picture->rgb.size());
}

bool is_grey(std::optional<double> mean) {
  return mean && std::abs(*mean - kGrey) < 2.0;
}

class StreamVideoTest : public ServerTest {
 protected:
  StreamVideoTest() : session_(make_session({{"scene", "helicopters"}})), client_(server_.port(), session_) {
    EXPECT_EQ(client_.hello({{"codecs", {"av9", "h264", "jpeg"}}})["codec"], "h264");
  }

  /// The next picture with its payload, acknowledged.
  static Heard next_picture_of(StreamClient& client) {
    while (auto heard = client.next()) {
      if (!heard->frame) continue;
      client.ack(heard->frame->frame);
      return *heard;
    }
    ADD_FAILURE() << "no picture came";
    return {};
  }
  Heard next_picture() { return next_picture_of(client_); }

  /// The next picture of that codec; without a frame if none came.
  static Heard next_of(StreamClient& client, FrameCodec codec) {
    for (int i = 0; i < 10'000; ++i) {
      Heard heard = next_picture_of(client);
      if (!heard.frame || heard.frame->codec == codec) return heard;
    }
    return {};
  }
  bool comes(FrameCodec codec) { return next_of(client_, codec).frame.has_value(); }

  const std::string session_;
  StreamClient client_;
};

TEST_F(StreamVideoTest, MovesAsVideoThatDecodesPictureByPicture) {
  VideoDecoder decoder;
  int videos = 0;
  for (int i = 0; i < 30 || videos < 10; ++i) {
    ASSERT_LT(i, 10'000);
    const Heard heard = next_picture();
    ASSERT_TRUE(heard.frame);
    if (heard.frame->codec != FrameCodec::kH264) continue;  // a slow machine leaves pictures out: files for a while
    EXPECT_TRUE(videos > 0 || heard.frame->is_key);
    ++videos;
    EXPECT_TRUE(is_grey(mean_of(decoder, heard)));
  }
}

TEST_F(StreamVideoTest, StandsStillAsFiles) {
  client_.input(1, {{"playing", false}});
  while (true) {
    const Heard heard = next_picture();
    ASSERT_TRUE(heard.frame);
    if (!heard.frame->is_final) continue;
    EXPECT_EQ(heard.frame->codec, FrameCodec::kJpeg);
    break;
  }
  client_.input(2, {{"playing", true}});
  EXPECT_TRUE(comes(FrameCodec::kH264));
}

TEST_F(StreamVideoTest, ANewSizeBeginsWithAKey) {
  ASSERT_TRUE(comes(FrameCodec::kH264));
  client_.input(1, {{"width", 32}, {"height", 48}});
  while (true) {
    const Heard heard = next_picture();
    ASSERT_TRUE(heard.frame);
    if (heard.frame->width != 32 || heard.frame->codec != FrameCodec::kH264) continue;
    EXPECT_TRUE(heard.frame->is_key);
    VideoDecoder decoder;
    EXPECT_TRUE(is_grey(mean_of(decoder, heard)));
    break;
  }
}

TEST_F(StreamVideoTest, SidesThatAreOddAreFiles) {
  client_.input(1, {{"width", 33}, {"height", 33}});
  for (int after = 0; after < 5;) {
    const Heard heard = next_picture();
    ASSERT_TRUE(heard.frame);
    if (heard.frame->width != 33) continue;
    EXPECT_EQ(heard.frame->codec, FrameCodec::kJpeg);
    ++after;
  }
}

TEST_F(StreamVideoTest, AClientInTroubleHasFiles) {
  ASSERT_TRUE(comes(FrameCodec::kH264));
  client_.send({{"type", "demotion"}, {"reason", "a test"}});
  ASSERT_TRUE(comes(FrameCodec::kJpeg));
  for (int i = 0; i < 10; ++i) EXPECT_EQ(next_picture().frame->codec, FrameCodec::kJpeg);
}

TEST_F(StreamVideoTest, OthersWhoWatchHaveWhatTheyTake) {
  StreamClient watcher(server_.port(), session_);
  EXPECT_EQ(watcher.hello({{"role", "viewer"}})["codec"], "jpeg");
  std::thread other([&] { EXPECT_TRUE(comes(FrameCodec::kH264)); });
  const auto frame = watcher.next_frame();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->codec, FrameCodec::kJpeg);
  other.join();
}

TEST_F(StreamVideoTest, IsCountedByItsCodec) {
  StreamClient watcher(server_.port(), session_);
  EXPECT_EQ(watcher.hello({{"role", "viewer"}})["codecs"], json::array({"jpeg", "h264"}));
  EXPECT_TRUE(comes(FrameCodec::kH264));
  EXPECT_TRUE(watcher.next_frame());
  for (const char* name : {"pictures_encoded_total", "encoded_bytes_total", "pictures_sent_total", "sent_bytes_total"})
    for (const char* codec : {"jpeg", "h264"})
      EXPECT_GT(metric(std::string("lightwell_") + name + "{codec=\"" + codec + "\"}"), 0.0) << name << codec;
}

TEST_F(StreamVideoTest, WhoComesLaterBeginsWithAKey) {
  ASSERT_TRUE(comes(FrameCodec::kH264));
  StreamClient watcher(server_.port(), session_);
  EXPECT_EQ(watcher.hello({{"role", "viewer"}, {"codecs", {"h264", "jpeg"}}})["codec"], "h264");
  std::atomic<bool> enough = false;
  std::thread driver([&] {
    while (!enough && next_picture().frame) {
    }
  });
  VideoDecoder decoder;
  for (int videos = 0; videos < 10; ++videos) {
    const Heard heard = next_of(watcher, FrameCodec::kH264);
    if (!heard.frame) break;
    EXPECT_TRUE(videos > 0 || heard.frame->is_key);
    EXPECT_TRUE(is_grey(mean_of(decoder, heard)));
  }
  enough = true;
  driver.join();
}

TEST_F(StreamVideoTest, WhoMissesPicturesGoesOnAtAKey) {
  StreamClient watcher(server_.port(), session_);
  ASSERT_EQ(watcher.hello({{"role", "viewer"}, {"codecs", {"h264", "jpeg"}}})["codec"], "h264");
  ASSERT_TRUE(next_of(watcher, FrameCodec::kH264).frame);
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(next_picture().frame);  // which the watcher, who acknowledges none, misses
  std::atomic<bool> enough = false;
  std::thread driver([&] {
    while (!enough && next_picture().frame) {
    }
  });
  VideoDecoder decoder;
  while (true) {
    const Heard heard = next_of(watcher, FrameCodec::kH264);
    if (!heard.frame) break;
    if (!heard.frame->is_key) continue;  // sent before
    EXPECT_TRUE(is_grey(mean_of(decoder, heard)));
    EXPECT_TRUE(is_grey(mean_of(decoder, next_of(watcher, FrameCodec::kH264))));
    break;
  }
  enough = true;
  driver.join();
}

TEST_F(StreamVideoTest, HoweverManyComeKeysAreRare) {
  const auto start = std::chrono::steady_clock::now();
  int keys = 0;
  std::vector<std::unique_ptr<StreamClient>> watchers;
  for (int i = 0; i < 40; ++i) {
    if (i % 4 == 0) {
      watchers.push_back(std::make_unique<StreamClient>(server_.port(), session_));
      ASSERT_EQ(watchers.back()->hello({{"role", "viewer"}, {"codecs", {"h264", "jpeg"}}})["codec"], "h264");
    }
    const Heard heard = next_picture();
    ASSERT_TRUE(heard.frame);
    keys += heard.frame->codec == FrameCodec::kH264 && heard.frame->is_key;
  }
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  EXPECT_LE(keys, 2.0 + seconds.count() / 2.0);
}

}  // namespace
}  // namespace lightwell::test
