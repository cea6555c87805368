#include "server/sequences/film_stream.h"

#include <fmt/format.h>

#include "renderer/image_io/image_io.h"
#include "server/operations/log.h"

namespace lightwell {

FilmStream::FilmStream(FilmFrames frames, WorkerPool& workers, std::shared_ptr<void> place)
    : frames_(std::move(frames)), workers_(workers), place_(std::move(place)) {}

std::optional<std::string> FilmStream::next() {
  std::lock_guard lock(mutex_);
  if (!ready_.empty()) {
    const std::string bytes = std::exchange(ready_, std::string());
    go_on();
    return fmt::format("{:x}\r\n{}\r\n", bytes.size(), bytes);
  }
  if (stage_ == Stage::kFailed || stage_ == Stage::kEnded) return {};
  if (stage_ == Stage::kEncoded) {
    stage_ = Stage::kEnded;
    return "0\r\n\r\n";
  }
  go_on();
  return std::string();
}

bool FilmStream::is_whole() const {
  std::lock_guard lock(mutex_);
  return stage_ != Stage::kFailed;
}

/// With the lock held. Where too much waits for the workers it is tried again when the connection asks again.
void FilmStream::go_on() {
  if (working_ || stage_ != Stage::kEncoding) return;
  working_ = workers_.try_post([self = shared_from_this()] { self->work(); });
}

void FilmStream::work() {
  const bool is_last = encoded_ == frames_.files.size();
  Result<std::string> bytes = [this]() -> Result<std::string> {
    try {
      return encode_next();
    } catch (const std::exception& error) {  // out of memory: whoever waits must learn it
      return Error{ErrorKind::kInternal, frames_.sequence, error.what()};
    }
  }();
  if (!bytes) log_event(LogLevel::kError, "film_failed", {{"reason", bytes.error().message()}});
  {
    std::lock_guard lock(mutex_);
    working_ = false;
    if (!bytes)
      stage_ = Stage::kFailed;
    else if (is_last)
      stage_ = Stage::kEncoded;
    if (bytes) ready_ = std::move(bytes).value();
  }
  wake_();
}

/// The next frame, or after the last one the end.
Result<std::string> FilmStream::encode_next() {
  if (!encoder_) {
    auto opened = open_film(frames_.size_px, frames_.fps);
    if (!opened) return opened.error();
    encoder_ = std::move(opened).value();
  }
  if (encoded_ == frames_.files.size()) {
    Result<std::string> end = encoder_->finish();
    encoder_.reset();
    return end;
  }
  const std::string& name = frames_.files[encoded_++];
  const Result<std::string> file = frames_.folder.read(frames_.sequence, name);
  if (!file) return file.error();
  const auto pixels = static_cast<std::uint64_t>(frames_.size_px.x) * static_cast<std::uint64_t>(frames_.size_px.y);
  const Result<Image> picture = decode_image(std::as_bytes(std::span(*file)), pixels);
  if (!picture) return picture.error();
  if (picture->size_px != frames_.size_px) return Error{ErrorKind::kInternal, name, "is of another size"};
  return encoder_->add(picture->rgba);
}

}  // namespace lightwell
