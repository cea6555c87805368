// A sequence's finished frames as a film, encoded while it is sent: one picture at a time, none before the client has
// taken what the last ones gave, and nothing is kept.
#pragma once

#include <mutex>

#include "server/data/frame_files.h"
#include "server/net/application.h"
#include "server/video/film.h"
#include "server/worker_pool.h"

namespace lightwell {

/// What a film is made of.
struct FilmFrames {
  FrameFolder folder;
  std::string sequence;
  std::vector<std::string> files;  // PNG or JPEG, in order
  glm::ivec2 size_px{};
  double fps = 30.0;
};

/// Written as chunks. A file that is gone or broken ends it before its time.
class FilmStream : public net::BodySource, public std::enable_shared_from_this<FilmStream> {
 public:
  /// `workers` outlives whoever asks for bytes. `place` is given back when the film has ended or nobody wants it.
  FilmStream(FilmFrames frames, WorkerPool& workers, std::shared_ptr<void> place);

  std::optional<std::string> next() override;
  bool is_whole() const override;
  void set_waker(std::function<void()> wake) override { wake_ = std::move(wake); }

 private:
  void go_on();
  void work();
  Result<std::string> encode_next();

  const FilmFrames frames_;
  WorkerPool& workers_;
  const std::shared_ptr<void> place_;
  std::function<void()> wake_;

  // Of whoever works: one at a time.
  std::unique_ptr<FilmEncoder> encoder_;
  std::size_t encoded_ = 0;  // frames

  mutable std::mutex mutex_;
  bool working_ = false;
  std::string ready_;  // bytes to be sent
  enum class Stage { kEncoding, kFailed, kEncoded, kEnded } stage_ = Stage::kEncoding;
};

}  // namespace lightwell
