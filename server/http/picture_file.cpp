#include "server/http/picture_file.h"

#include <fmt/format.h>

#include <chrono>

#include "protocol/names.h"
#include "renderer/image_io/image_io.h"
#include "server/convert.h"
#include "server/render/jpeg.h"

namespace lightwell::http {
namespace {

constexpr int kQuality = 95;

std::string text_of(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

Result<std::string> jpeg_file(const Frame& frame) {
  const auto file = encode_jpeg(frame.display_rgbx, frame.size_px, kQuality, Chroma::kFull);
  if (!file) return file.error();
  return std::string(file->begin(), file->end());
}

Result<std::string> png_file(const Frame& frame) {
  std::vector<std::uint8_t> rgb;
  rgb.reserve(frame.display_rgbx.size() / 4 * 3);
  for (std::size_t i = 0; i + 3 < frame.display_rgbx.size(); i += 4)
    rgb.insert(rgb.end(), &frame.display_rgbx[i], &frame.display_rgbx[i] + 3);
  const auto file = encode_ldr("png", frame.size_px, rgb);
  if (!file) return file.error();
  return text_of(*file);
}

Result<std::string> exr_file(const Frame& frame) {
  const auto file = encode_exr(FloatImage{frame.size_px, 3, frame.linear_rgb});
  if (!file) return file.error();
  return text_of(*file);
}

/// "shadow maps" is no token (RFC 9110), "shadow-maps" is.
std::string metric_name(std::string_view stage) {
  std::string name(stage);
  for (char& c : name)
    if (c == ' ') c = '-';
  return name;
}

}  // namespace

Response picture_response(const Frame& frame, protocol::ImageFormat format) {
  const auto start = std::chrono::steady_clock::now();
  Result<std::string> file = format == protocol::ImageFormat::kJpeg  ? jpeg_file(frame)
                             : format == protocol::ImageFormat::kPng ? png_file(frame)
                                                                     : exr_file(frame);
  if (!file) return problem_response(problem_of(file.error()));
  const std::chrono::duration<double, std::milli> encode_time = std::chrono::steady_clock::now() - start;

  std::string timing;
  for (const StageTime& stage : frame.stages)
    timing += fmt::format("{};dur={:.3f}, ", metric_name(stage.name), stage.ms);
  timing += fmt::format("render;dur={:.3f}, encode;dur={:.3f}", frame.total_ms, encode_time.count());
  return {200,
          std::string(protocol::media_type_of(format)),
          std::move(file).value(),
          {{"Server-Timing", timing},
           {"Cache-Control", "no-store"},
           {"X-Lightwell-Rays", std::to_string(frame.rays)},
           {"X-Lightwell-Exposure-Ev", fmt::format("{:.4f}", frame.exposure_ev)}}};
}

}  // namespace lightwell::http
