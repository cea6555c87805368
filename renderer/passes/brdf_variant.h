// What the BRDF of a frame must be able to do beyond the plain one: a software device pays for all that a shader could
// do.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "renderer/gl/program.h"

namespace lightwell {

/// The variants of shaders/brdf.glsl.
struct BrdfVariant {
  bool multiscatter = false;  // the setting `multiple_scattering`
  bool lobes = false;         // a material has clearcoat, sheen, transmission or a specular colour

  bool plain() const { return !multiscatter && !lobes; }
  auto operator<=>(const BrdfVariant&) const = default;
};

/// Programs of a pass for all BRDFs but the plain one, compiled when a frame first needs them. `Variant` is made of a
/// program and keeps its uniforms.
template <class Variant>
class BrdfVariants {
 public:
  /// `compile` makes the program with the given defines and what else it needs.
  using Compile = std::function<gl::ProgramPtr(const std::vector<std::string>& defines)>;
  explicit BrdfVariants(Compile compile) : compile_(std::move(compile)) {}

  Variant& at(BrdfVariant brdf) {
    const auto found = variants_.find(brdf);
    if (found != variants_.end()) return found->second;
    std::vector<std::string> defines;
    if (brdf.multiscatter) defines.push_back("MULTISCATTER 1");
    if (brdf.lobes) defines.push_back("HAS_LOBES 1");
    return variants_.emplace(brdf, Variant(compile_(defines))).first->second;
  }

 private:
  Compile compile_;
  std::map<BrdfVariant, Variant> variants_;
};

/// `defines` and `more` together.
inline std::vector<std::string> with_defines(std::vector<std::string> defines, const std::vector<std::string>& more) {
  defines.insert(defines.end(), more.begin(), more.end());
  return defines;
}

}  // namespace lightwell
