// Readers of what several messages hold.
#pragma once

#include <algorithm>
#include <array>

#include "protocol/messages.h"
#include "protocol/reader.h"

namespace lightwell::protocol {

inline constexpr double kLongestTime = 1e9;                                  // seconds
inline constexpr std::size_t kMostEdits = 4096;                              // in one patch
inline constexpr std::size_t kLongestPath = 1024;                            // bytes of an edit's path
inline constexpr std::int64_t kLargestExactInteger = 9'007'199'254'740'991;  // 2^53 - 1

inline constexpr ReadNumber read_time{0, kLongestTime};
inline constexpr ReadInteger<std::uint16_t> read_pixels{1, 65535};
inline constexpr ReadInteger<std::uint32_t> read_sequence{1, 0xffffffff};
inline constexpr ReadInteger<std::uint32_t> read_index{0, 0x7fffffff};
inline constexpr ReadInteger<std::uint64_t> read_count{0, kLargestExactInteger};
inline constexpr ReadString read_token{1, 256};   // ids and names of choices
inline constexpr ReadString read_text{0, 65536};  // names from files, details of problems

/// An array of exactly `count` numbers.
template <std::size_t count>
void read_numbers(const Value& value, std::array<double, count>& out) {
  std::vector<double> numbers;
  ReadArray{count, count, read_any_number}(value, numbers);
  if (numbers.size() == count) std::copy(numbers.begin(), numbers.end(), out.begin());
}

void read_scene_name(const Value& value, std::string& out);
void read_free_camera(const Value& value, FreeCamera& out);
void read_camera(const Value& value, CameraSpec& out);
void read_settings(const Value& value, SettingsSpec& out);
void read_image_format(const Value& value, ImageFormat& out);
void read_role(const Value& value, Role& out);

/// An array of at most kMostEdits objects with `op` one of add, remove, replace, test, `path` a JSON pointer and, but
/// for remove, a `value`. Members that RFC 6902 does not define are ignored, as it says.
void read_edits(const Value& value, Edits& out);

/// The members of a SessionPatch, from an object that may have others.
void read_change(ObjectReader& object, SessionPatch& out);

}  // namespace lightwell::protocol
