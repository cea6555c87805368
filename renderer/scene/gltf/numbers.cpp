#include "renderer/scene/gltf/numbers.h"

#include <algorithm>

namespace lightwell::gltf {

float to_float(double value) {
  return static_cast<float>(std::clamp(value, -kMaxFloat, kMaxFloat));
}

float clamped(Context& context, double value, double low, double high, const std::string& where,
              std::string_view name) {
  const double result = std::clamp(value, low, high);
  if (result != value)
    context.warnings.add(where, std::string(name) + " is " + to_text(value) + "; " + to_text(result) + " is used");
  return static_cast<float>(result);
}

}  // namespace lightwell::gltf
