// Values of the command line. The first byte says which kind the rest is meant to be.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "server/command_line/parse_values.h"

namespace {

using namespace lightwell;

void require(bool holds) {
  if (!holds) std::abort();
}

/// An error says something; a value is as `good` wants it.
template <class T, class Good>
void check(const Result<T>& value, const Good& good) {
  require(value ? good(*value) : !value.error().what.empty());
}

void read_any(std::uint8_t kind, const std::string& text) {
  constexpr double kMost = 1e6;
  const auto finite = [](const glm::vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); };
  switch (kind % 8) {
    case 0:
      return check(parse_size(text), [](glm::ivec2 size) {
        return size.x >= 1 && size.y >= 1 && size.x <= kMaxPictureSide && size.y <= kMaxPictureSide;
      });
    case 1:
      return check(parse_vec3(text), finite);
    case 2:
      return check(parse_color(text),
                   [&](const glm::vec3& c) { return finite(c) && c.r >= 0.0f && c.g >= 0.0f && c.b >= 0.0f; });
    case 3:
      return check(parse_frame_range(text),
                   [](FrameRange r) { return r.first >= 0 && r.first <= r.last && r.last <= kMaxFrameNumber; });
    case 4:
      return check(parse_number(text, -kMost, kMost), [](double x) { return x >= -kMost && x <= kMost; });
    case 5:
      return check(parse_integer(text, -5, 1'000'000'000'000),
                   [](long long x) { return x >= -5 && x <= 1'000'000'000'000; });
    case 6:
      return check(parse_device(text), [](const std::string& device) {
        return device == "software" || device.find_first_not_of("0123456789") == std::string::npos;
      });
    default:
      if (is_frame_pattern(text)) require(frame_file_name(text, 42).find('%') == std::string::npos);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > 0) read_any(data[0], std::string(reinterpret_cast<const char*>(data + 1), size - 1));
  return 0;
}
