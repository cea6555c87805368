#include "server/command_line/parse_values.h"

#include <charconv>
#include <cmath>
#include <optional>
#include <regex>
#include <sstream>
#include <vector>

#include "renderer/check.h"

namespace lightwell {

namespace {

// The whole text as a number; strtod and its friends would take blanks, hexadecimals and what the locale says.
template <class T>
std::optional<T> whole_number(std::string_view text) {
  T value{};
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || text.empty()) return std::nullopt;
  return value;
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  for (const char character : text) {
    if (character == separator)
      parts.emplace_back();
    else
      parts.back() += character;
  }
  return parts;
}

Error expected(const std::string& what, const std::string& text) {
  return invalid_input("", "expected " + what + ", not \"" + text + "\"");
}

std::string plain(double number) {
  std::ostringstream text;
  text << number;
  return text.str();
}

const std::regex& frame_place() {
  static const std::regex place("%(0[1-9])?d");
  return place;
}

}  // namespace

Result<glm::ivec2> parse_size(const std::string& text) {
  const Error error = expected("WxH with both sides from 1 to " + std::to_string(kMaxPictureSide), text);
  const std::vector<std::string> parts = split(text, 'x');
  if (parts.size() != 2) return error;
  const auto width = whole_number<int>(parts[0]), height = whole_number<int>(parts[1]);
  if (!width || !height) return error;
  if (*width < 1 || *width > kMaxPictureSide || *height < 1 || *height > kMaxPictureSide) return error;
  return glm::ivec2(*width, *height);
}

Result<glm::vec3> parse_vec3(const std::string& text) {
  const std::vector<std::string> parts = split(text, ',');
  if (parts.size() != 3) return expected("three numbers X,Y,Z", text);
  glm::vec3 value;
  for (int i = 0; i < 3; ++i) {
    const auto number = whole_number<float>(parts[static_cast<std::size_t>(i)]);
    if (!number || !std::isfinite(*number)) return expected("three finite numbers X,Y,Z", text);
    value[i] = *number;
  }
  return value;
}

Result<glm::vec3> parse_color(const std::string& text) {
  const Result<glm::vec3> color = parse_vec3(text);
  if (!color || color->x < 0.0f || color->y < 0.0f || color->z < 0.0f)
    return expected("three numbers R,G,B that are not negative", text);
  return color;
}

Result<FrameRange> parse_frame_range(const std::string& text) {
  const std::vector<std::string> parts = split(text, ':');
  if (parts.size() == 2) {
    const auto first = whole_number<int>(parts[0]), last = whole_number<int>(parts[1]);
    if (first && last && 0 <= *first && *first <= *last && *last <= kMaxFrameNumber) return FrameRange{*first, *last};
  }
  return expected("frames A:B with 0 <= A <= B <= " + std::to_string(kMaxFrameNumber), text);
}

Result<double> parse_number(const std::string& text, double least, double most) {
  const auto number = whole_number<double>(text);
  if (number && std::isfinite(*number) && least <= *number && *number <= most) return *number;
  return expected("a number from " + plain(least) + " to " + plain(most), text);
}

Result<long long> parse_integer(const std::string& text, long long least, long long most) {
  const auto number = whole_number<long long>(text);
  if (number && least <= *number && *number <= most) return *number;
  return expected("an integer from " + std::to_string(least) + " to " + std::to_string(most), text);
}

Result<std::string> parse_device(const std::string& text) {
  constexpr int kMostDevices = 1000;
  if (text == "software") return text;
  if (const auto index = parse_integer(text, 0, kMostDevices)) return std::to_string(*index);
  return expected("\"software\" or an index as `lightwell devices` prints it", text);
}

bool is_frame_pattern(const std::string& pattern) {
  const auto begin = std::sregex_iterator(pattern.begin(), pattern.end(), frame_place());
  const auto places = std::distance(begin, std::sregex_iterator());
  const auto percents = std::count(pattern.begin(), pattern.end(), '%');
  return places == 1 && percents == 1;
}

std::string frame_file_name(const std::string& pattern, int frame) {
  std::smatch place;
  LIGHTWELL_CHECK(std::regex_search(pattern, place, frame_place()));
  std::string number = std::to_string(frame);
  const std::size_t width = place[1].matched ? static_cast<std::size_t>(place[1].str()[1] - '0') : 0;
  if (number.size() < width) number.insert(0, width - number.size(), '0');
  return place.prefix().str() + number + place.suffix().str();
}

}  // namespace lightwell
