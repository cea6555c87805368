#include "server/http/picture_file.h"

#include <fmt/format.h>

#include <chrono>

#include "protocol/names.h"
#include "server/convert.h"
#include "server/render/encode_picture.h"

namespace lightwell::http {
namespace {

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
  Result<std::string> file = encode_picture(frame, format);
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
           {"X-Lightwell-Exposure-Ev", fmt::format("{:.4f}", frame.exposure_ev)},
           {"X-Lightwell-Clamped-Share", fmt::format("{:.6f}", frame.clamped_share)}}};
}

}  // namespace lightwell::http
