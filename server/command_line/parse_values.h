// Text of the command line into checked values. An error says what was given and what is expected; its `where` is
// empty, since only the caller knows the option's name.
#pragma once

#include <glm/glm.hpp>
#include <string>

#include "renderer/error.h"

namespace lightwell {

constexpr int kMaxPictureSide = 16384;
constexpr int kMaxFrameNumber = 999'999;

/// "WxH", each 1..16384.
Result<glm::ivec2> parse_size(const std::string& text);

/// "X,Y,Z", each finite.
Result<glm::vec3> parse_vec3(const std::string& text);

/// "R,G,B", each finite and not negative.
Result<glm::vec3> parse_color(const std::string& text);

/// The frames first..last, both included.
struct FrameRange {
  int first = 0;
  int last = 0;
};

/// "A:B" with 0 <= A <= B <= 999999.
Result<FrameRange> parse_frame_range(const std::string& text);

/// A finite number in [least, most].
Result<double> parse_number(const std::string& text, double least, double most);

/// An integer in [least, most].
Result<long long> parse_integer(const std::string& text, long long least, long long most);

/// "software", or a device's index in decimal, written plainly: -0 is 0.
Result<std::string> parse_device(const std::string& text);

/// Whether `pattern` holds a place for a frame's number: %d or %0Nd (N 1..9), exactly once, and no other %.
bool is_frame_pattern(const std::string& pattern);

/// `pattern` with the number in its place. `is_frame_pattern(pattern)` must hold.
std::string frame_file_name(const std::string& pattern, int frame);

}  // namespace lightwell
