#include "server/render/jpeg.h"

#include <turbojpeg.h>

#include "renderer/check.h"

namespace lightwell {
namespace {

constexpr std::size_t kMostBytesKept = 16u << 20;

/// The library's handle and a buffer as large as any file of the largest picture so far.
class Encoder {
 public:
  Encoder() : handle_(tjInitCompress()) {}
  ~Encoder() {
    if (handle_) tjDestroy(handle_);
  }
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;

  Result<std::vector<std::uint8_t>> encode(std::span<const std::uint8_t> rgbx, glm::ivec2 size_px, int quality,
                                           int sampling) {
    if (!handle_) return failure();
    const unsigned long most_bytes = tjBufSize(size_px.x, size_px.y, sampling);
    if (buffer_.size() < most_bytes) buffer_.resize(most_bytes);
    unsigned char* bytes = buffer_.data();
    unsigned long count = most_bytes;
    const int failed = tjCompress2(handle_, rgbx.data(), size_px.x, 0, size_px.y, TJPF_RGBX, &bytes, &count, sampling,
                                   quality, TJFLAG_NOREALLOC);
    if (failed) return failure();
    std::vector<std::uint8_t> file(bytes, bytes + count);
    if (buffer_.size() > kMostBytesKept) buffer_ = {};
    return file;
  }

 private:
  Error failure() const { return Error{ErrorKind::kInternal, "libjpeg-turbo", tjGetErrorStr2(handle_)}; }

  tjhandle handle_;
  std::vector<std::uint8_t> buffer_;
};

}  // namespace

Result<std::vector<std::uint8_t>> encode_jpeg(std::span<const std::uint8_t> rgbx, glm::ivec2 size_px, int quality,
                                              Chroma chroma) {
  LIGHTWELL_CHECK_OP(rgbx.size(), ==, static_cast<std::size_t>(size_px.x) * static_cast<std::size_t>(size_px.y) * 4);
  thread_local Encoder encoder;
  return encoder.encode(rgbx, size_px, quality, chroma == Chroma::kFull ? TJSAMP_444 : TJSAMP_420);
}

}  // namespace lightwell
