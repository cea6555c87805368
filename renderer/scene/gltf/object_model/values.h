// Single values between JSON and the scene. Every read checks type and range and leaves `out` alone if it refuses;
// `where` is the pointer that the error names.
#pragma once

#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "renderer/error.h"
#include "renderer/scene/scene.h"

namespace lightwell::object_model {

using Json = nlohmann::json;

/// What a number may be. Beyond `kLargest` squares leave the range of a float.
struct Range {
  static constexpr double kLargest = 1e15;

  double low = -kLargest;
  double high = kLargest;
  bool low_open = false;  // `low` itself is refused
};

inline constexpr Range kUnit{0.0, 1.0};
inline constexpr Range kNotNegative{0.0, Range::kLargest};
inline constexpr Range kPositive{0.0, Range::kLargest, true};

/// "12", "null", "an array of 3", "a string of 70000 bytes".
std::string in_words(const Json& value);

Status read_value(const Json& value, const Range& range, const std::string& where, float& out);
Status read_value(const Json& value, const Range& range, const std::string& where, int& out);
Status read_value(const Json& value, const Range& range, const std::string& where, bool& out);
Status read_value(const Json& value, const Range& range, const std::string& where, std::string& out);
Status read_value(const Json& value, const Range& range, const std::string& where, AlphaMode& out);
Status read_value(const Json& value, const Range& range, const std::string& where, LightKind& out);
Status read_value(const Json& value, const Range& range, const std::string& where, glm::vec2& out);
Status read_value(const Json& value, const Range& range, const std::string& where, glm::vec3& out);
Status read_value(const Json& value, const Range& range, const std::string& where, glm::vec4& out);

/// Exactly `count` numbers; an error names the element.
Status read_numbers(const Json& value, const Range& range, const std::string& where, std::size_t count, float* out);

/// A float travels as the shortest decimal that is it: 0.1 and not 0.10000000149011612.
Json write_value(float value);
Json write_value(int value);
Json write_value(bool value);
Json write_value(const std::string& value);
Json write_value(AlphaMode value);
Json write_value(LightKind value);
Json write_value(const glm::vec2& value);
Json write_value(const glm::vec3& value);
Json write_value(const glm::vec4& value);
Json write_numbers(const float* values, std::size_t count);

/// Equal as RFC 6902's test says, numbers compared as the floats the scene holds.
bool same_value(const Json& a, const Json& b);

}  // namespace lightwell::object_model
