#include "renderer/scene/gltf/object_model/values.h"

#include <array>
#include <charconv>
#include <cmath>
#include <utility>

namespace lightwell::object_model {
namespace {

constexpr std::size_t kLongestName = 1024;

constexpr std::array<std::pair<AlphaMode, const char*>, 3> kAlphaModes{
    {{AlphaMode::kOpaque, "OPAQUE"}, {AlphaMode::kMask, "MASK"}, {AlphaMode::kBlend, "BLEND"}}};
constexpr std::array<std::pair<LightKind, const char*>, 3> kLightKinds{
    {{LightKind::kDirectional, "directional"}, {LightKind::kPoint, "point"}, {LightKind::kSpot, "spot"}}};

template <class Enum>
Status read_name(const Json& value, const std::array<std::pair<Enum, const char*>, 3>& names, const std::string& where,
                 Enum& out) {
  for (const auto& [candidate, name] : names) {
    if (value != name) continue;
    out = candidate;
    return Done{};
  }
  return invalid_input(where, "must be \"" + std::string(names[0].second) + "\", \"" + names[1].second + "\" or \"" +
                                  names[2].second + "\", not " + in_words(value));
}

template <class Enum>
Json write_name(Enum value, const std::array<std::pair<Enum, const char*>, 3>& names) {
  for (const auto& [candidate, name] : names)
    if (candidate == value) return name;
  return nullptr;
}

bool contains(const Range& range, double number) {
  return (range.low_open ? number > range.low : number >= range.low) && number <= range.high;
}

std::string range_in_words(const Range& range) {
  return std::string(range.low_open ? "above " : "from ") + in_words(range.low) + " to " + in_words(range.high);
}

}  // namespace

std::string in_words(const Json& value) {
  constexpr std::size_t kLongest = 60;
  if (value.is_array()) return "an array of " + std::to_string(value.size());
  if (value.is_object()) return "an object";
  if (value.is_string() && value.get_ref<const std::string&>().size() > kLongest)
    return "a string of " + std::to_string(value.get_ref<const std::string&>().size()) + " bytes";
  return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Status read_value(const Json& value, const Range& range, const std::string& where, float& out) {
  if (!value.is_number()) return invalid_input(where, "must be a number, not " + in_words(value));
  const double number = value.get<double>();
  if (!contains(range, number))  // NaN as well
    return invalid_input(where, "must be a number " + range_in_words(range) + ", not " + in_words(value));
  out = static_cast<float>(number);
  return Done{};
}

Status read_value(const Json& value, const Range& range, const std::string& where, int& out) {
  const double number = value.is_number() ? value.get<double>() : std::nan("");
  if (!contains(range, number) || number != std::floor(number))
    return invalid_input(where, "must be a whole number " + range_in_words(range) + ", not " + in_words(value));
  out = static_cast<int>(number);
  return Done{};
}

Status read_value(const Json& value, const Range&, const std::string& where, bool& out) {
  if (!value.is_boolean()) return invalid_input(where, "must be true or false, not " + in_words(value));
  out = value.get<bool>();
  return Done{};
}

Status read_value(const Json& value, const Range&, const std::string& where, std::string& out) {
  if (!value.is_string() || value.get_ref<const std::string&>().size() > kLongestName)
    return invalid_input(
        where, "must be a string of at most " + std::to_string(kLongestName) + " bytes, not " + in_words(value));
  out = value.get_ref<const std::string&>();
  return Done{};
}

Status read_value(const Json& value, const Range&, const std::string& where, AlphaMode& out) {
  return read_name(value, kAlphaModes, where, out);
}

Status read_value(const Json& value, const Range&, const std::string& where, LightKind& out) {
  return read_name(value, kLightKinds, where, out);
}

Status read_value(const Json& value, const Range& range, const std::string& where, glm::vec2& out) {
  return read_numbers(value, range, where, 2, &out.x);
}

Status read_value(const Json& value, const Range& range, const std::string& where, glm::vec3& out) {
  return read_numbers(value, range, where, 3, &out.x);
}

Status read_value(const Json& value, const Range& range, const std::string& where, glm::vec4& out) {
  return read_numbers(value, range, where, 4, &out.x);
}

Status read_numbers(const Json& value, const Range& range, const std::string& where, std::size_t count, float* out) {
  if (!value.is_array() || value.size() != count)
    return invalid_input(where, "must be an array of " + std::to_string(count) + " numbers, not " + in_words(value));
  std::vector<float> numbers(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Status read = read_value(value[i], range, where + '/' + std::to_string(i), numbers[i]);
    if (!read) return read;
  }
  std::copy(numbers.begin(), numbers.end(), out);
  return Done{};
}

Json write_value(float value) {
  std::array<char, 32> text{};
  const auto written = std::to_chars(text.data(), text.data() + text.size(), value);
  double decimal = 0.0;
  const auto read = std::from_chars(text.data(), written.ptr, decimal);
  return read.ec == std::errc() ? decimal : static_cast<double>(value);
}

Json write_value(int value) {
  return value;
}
Json write_value(bool value) {
  return value;
}
Json write_value(const std::string& value) {
  return value;
}
Json write_value(AlphaMode value) {
  return write_name(value, kAlphaModes);
}
Json write_value(LightKind value) {
  return write_name(value, kLightKinds);
}
Json write_value(const glm::vec2& value) {
  return write_numbers(&value.x, 2);
}
Json write_value(const glm::vec3& value) {
  return write_numbers(&value.x, 3);
}
Json write_value(const glm::vec4& value) {
  return write_numbers(&value.x, 4);
}

Json write_numbers(const float* values, std::size_t count) {
  Json array = Json::array();
  for (std::size_t i = 0; i < count; ++i) array.push_back(write_value(values[i]));
  return array;
}

bool same_value(const Json& a, const Json& b) {
  if (a.is_number() && b.is_number()) return a.get<float>() == b.get<float>();
  if (a.type() != b.type() || (a.is_structured() && a.size() != b.size())) return false;
  if (a.is_array()) return std::equal(a.begin(), a.end(), b.begin(), same_value);
  if (!a.is_object()) return a == b;
  for (const auto& [name, member] : a.items())
    if (!b.contains(name) || !same_value(member, b[name])) return false;
  return true;
}

}  // namespace lightwell::object_model
