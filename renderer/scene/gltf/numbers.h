// Numbers from a file, forced into the range that they must have.
#pragma once

#include <limits>
#include <string>
#include <string_view>

#include "renderer/scene/gltf/context.h"

namespace lightwell::gltf {

inline constexpr double kMaxFloat = std::numeric_limits<float>::max();

/// The nearest finite float.
float to_float(double value);

/// `value` if it lies in [low, high], else the nearer end and a warning that names `where`/`name`.
float clamped(Context& context, double value, double low, double high, const std::string& where, std::string_view name);

/// The same for every element of a vector given as doubles, as many as Vector has.
template <class Vector>
Vector clamped_vector(Context& context, const std::vector<double>& values, double low, double high,
                      const std::string& where, std::string_view name) {
  Vector result{};
  for (glm::length_t i = 0; i < Vector::length(); ++i)
    result[i] = clamped(context, values.at(static_cast<std::size_t>(i)), low, high, where, name);
  return result;
}

}  // namespace lightwell::gltf
