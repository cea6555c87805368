// Films: by the encoder alone, and of sequences over HTTP; read back by libavformat.
extern "C" {
#include <libavformat/avformat.h>
}

#include <filesystem>
#include <fstream>

#include "server/random_id.h"
#include "server/video/film.h"
#include "tests/integration/data_folder.h"
#include "tests/integration/server_fixture.h"
#include "tests/integration/test_pictures.h"
#include "tests/integration/video_decoder.h"

namespace lightwell::test {
namespace {

struct ReadFilm {
  double fps = 0.0;
  std::vector<double> times_s;
  std::vector<DecodedPicture> pictures;
};

/// What a player makes of the file; nothing if it makes nothing.
ReadFilm read_film(const std::string& bytes) {
  const auto path = std::filesystem::temp_directory_path() / ("lightwell-" + random_id() + ".mp4");
  std::ofstream(path, std::ios::binary) << bytes;
  ReadFilm film;
  AVFormatContext* file = nullptr;
  if (avformat_open_input(&file, path.c_str(), nullptr, nullptr) == 0 &&
      avformat_find_stream_info(file, nullptr) >= 0) {
    const AVStream& stream = *file->streams[0];
    film.fps = av_q2d(stream.avg_frame_rate);
    AVCodecContext* decoder = avcodec_alloc_context3(avcodec_find_decoder(stream.codecpar->codec_id));
    avcodec_parameters_to_context(decoder, stream.codecpar);
    decoder->thread_count = 1;
    AVPacket* packet = av_packet_alloc();
    AVFrame* frame = av_frame_alloc();
    const auto take_pictures = [&] {
      while (avcodec_receive_frame(decoder, frame) == 0) {
        film.pictures.push_back(picture_of(*frame));
        film.times_s.push_back(static_cast<double>(frame->pts) * av_q2d(stream.time_base));
      }
    };
    if (avcodec_open2(decoder, nullptr, nullptr) == 0) {
      for (; av_read_frame(file, packet) == 0; av_packet_unref(packet)) {
        avcodec_send_packet(decoder, packet);
        take_pictures();
      }
      avcodec_send_packet(decoder, nullptr);
      take_pictures();
    }
    av_frame_free(&frame);
    av_packet_free(&packet);
    avcodec_free_context(&decoder);
  }
  avformat_close_input(&file);
  std::filesystem::remove(path);
  return film;
}

std::string film_of(int pictures, glm::ivec2 size_px, double fps) {
  auto encoder = open_film(size_px, fps);
  EXPECT_TRUE(encoder) << encoder.error().message();
  std::string bytes;
  for (int i = 0; i < pictures; ++i) bytes += (*encoder)->add(moving_picture(size_px, i)).value();
  return bytes + (*encoder)->finish().value();
}

TEST(Film, HasEveryPictureAtItsTimeAndNearlyAsItWas) {
  const glm::ivec2 size_px(160, 90);
  const ReadFilm film = read_film(film_of(60, size_px, 24.0));
  EXPECT_DOUBLE_EQ(film.fps, 24.0);
  ASSERT_EQ(film.pictures.size(), 60u);
  for (std::size_t i = 0; i < 60; ++i) {
    EXPECT_NEAR(film.times_s[i], static_cast<double>(i) / 24.0, 1e-3);
    EXPECT_GT(psnr(film.pictures[i], moving_picture(size_px, static_cast<int>(i))), 36.0) << "picture " << i;
  }
  EXPECT_EQ(film.pictures[0].range, AVCOL_RANGE_MPEG);
  EXPECT_EQ(film.pictures[0].matrix, AVCOL_SPC_BT709);
  EXPECT_EQ(film.pictures[0].transfer, AVCOL_TRC_IEC61966_2_1);
}

TEST(Film, OfTheSamePicturesHasTheSameBytes) {
  const std::string bytes = film_of(20, {64, 48}, 30.0);
  EXPECT_EQ(film_of(20, {64, 48}, 30.0), bytes);
  EXPECT_EQ(bytes.substr(4, 4), "ftyp");
}

TEST(Film, HasAnyRateThatASequenceHas) {
  for (const double fps : {0.001, 23.976, 1000.0}) {
    const ReadFilm film = read_film(film_of(3, {16, 16}, fps));
    ASSERT_EQ(film.pictures.size(), 3u) << fps;
    EXPECT_NEAR(film.times_s[2], 2.0 / fps, 1e-3 / fps) << fps;
  }
}

ServeOptions options_with_folder(const std::filesystem::path& folder) {
  ServeOptions options = test_options();
  options.data_dir = folder.string();
  return options;
}

class SequenceFilmTest : private DataFolder, public ServerTest {
 protected:
  SequenceFilmTest() : ServerTest(options_with_folder(DataFolder::path())) {}

  std::string submit(json request) const {
    request.merge_patch({{"scene", "cornell"}});
    const Answer answer = ask("POST", "/v1/sequences", request);
    EXPECT_EQ(answer.status, 202) << answer.body;
    return json::parse(answer.body).value("id", "");
  }
  bool is_done(const std::string& id) const {
    return comes_true([&] { return json::parse(ask("GET", "/v1/sequences/" + id).body)["state"] == "done"; });
  }
  std::filesystem::path file(const std::string& id, const std::string& name) const {
    return DataFolder::path() / "sequences" / id / name;
  }

  struct Film {
    Answer answer;          // its head
    std::string bytes;      // without the marks of chunks
    bool is_whole = false;  // the last chunk came
  };
  Film fetch(const std::string& target) const {
    Line line(server_.port());
    line.send("GET " + target + " HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
    Film film{read_answer(line), {}, false};
    const std::string text = line.receive_all();
    for (std::size_t at = 0; at < text.size();) {
      const auto end = text.find("\r\n", at);
      const std::size_t bytes = end == std::string::npos ? 0 : std::stoul(text.substr(at, end - at), nullptr, 16);
      film.is_whole = bytes == 0 && text.substr(at) == "0\r\n\r\n";
      if (bytes == 0) break;
      film.bytes += text.substr(end + 2, bytes);
      at = end + 2 + bytes + 2;
    }
    return film;
  }
};

TEST_F(SequenceFilmTest, IsMadeOfTheFramesAndIsTheSameEveryTime) {
  const std::string id =
      submit({{"width", 32}, {"height", 16}, {"last_frame", 6}, {"fps", 12}, {"views", {"final", "depth"}}});
  ASSERT_TRUE(is_done(id));
  const std::string path = "/v1/sequences/" + id + "/video";
  const Film film = fetch(path);
  ASSERT_EQ(film.answer.status, 200) << film.answer.head;
  EXPECT_EQ(film.answer.field("Content-Type"), "video/mp4");
  EXPECT_TRUE(film.is_whole);
  const ReadFilm read = read_film(film.bytes);
  EXPECT_DOUBLE_EQ(read.fps, 12.0);
  ASSERT_EQ(read.pictures.size(), 7u);
  for (const DecodedPicture& picture : read.pictures) {
    EXPECT_EQ(picture.width, 32);
    EXPECT_EQ(picture.height, 16);
    EXPECT_NEAR(picture.at(16, 8)[1], 51.0, 2.0);  // FakeSource's grey
  }
  EXPECT_EQ(fetch(path).bytes, film.bytes);
  EXPECT_EQ(fetch(path + "?view=final").bytes, film.bytes);
  EXPECT_EQ(fetch(path + "?view=depth").answer.status, 200);
  const std::string fields = "If-None-Match: " + film.answer.field("ETag") + "\r\n";
  EXPECT_EQ(ask("GET", path, {}, {}, fields).status, 304);
  EXPECT_EQ(ask("HEAD", path).status, 200);
}

TEST_F(SequenceFilmTest, RefusesWhatIsNoFilm) {
  const auto refusal = [&](const std::string& id, const std::string& query = {}) {
    return problem(ask("GET", "/v1/sequences/" + id + "/video" + query));
  };
  EXPECT_EQ(refusal("0123456789abcdef0123456789abcdef")["status"], 404);
  EXPECT_EQ(refusal(submit({{"width", 8}, {"height", 8}, {"last_frame", 0}, {"format", "exr"}}))["status"], 422);
  EXPECT_EQ(refusal(submit({{"width", 9}, {"height", 8}, {"last_frame", 0}}))["status"], 422);
  const std::string id = submit({{"width", 8}, {"height", 8}, {"last_frame", 0}});
  EXPECT_EQ(refusal(id, "?view=depth")["pointer"], "/view");
  EXPECT_EQ(refusal(id, "?size=1")["pointer"], "/size");
  ASSERT_TRUE(is_done(id));
  studio_->held = true;
  const json not_done = refusal(submit({{"width", 8}, {"height", 8}, {"last_frame", 1}}));
  EXPECT_EQ(not_done["status"], 409);
  EXPECT_EQ(not_done["detail"], "the sequence is not done: 0 of 2 frames are finished");
  studio_->held = false;
}

TEST_F(SequenceFilmTest, BreaksOffWhereAFrameIsGoneOrBroken) {
  const std::string id = submit({{"width", 8}, {"height", 8}, {"last_frame", 3}});
  ASSERT_TRUE(is_done(id));
  std::ofstream(file(id, "000002.final.png")) << "no picture";
  EXPECT_FALSE(fetch("/v1/sequences/" + id + "/video").is_whole);
  std::filesystem::remove(file(id, "000000.final.png"));
  EXPECT_FALSE(fetch("/v1/sequences/" + id + "/video").is_whole);
  EXPECT_EQ(ask("GET", "/healthz").status, 200);
}

}  // namespace
}  // namespace lightwell::test
