// Programs made from one source with different defines, because a software device pays for everything a shader could
// do.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "renderer/gl/program.h"

namespace lightwell::gl {

/// "NAME VALUE" each.
using Defines = std::vector<std::string>;

/// One list after the other.
inline Defines joined(Defines a, const Defines& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// Compiles a variant when it is first asked for. `Variant` is made from a ProgramPtr and holds its uniforms.
template <class Variant>
class Variants {
 public:
  explicit Variants(std::function<ProgramPtr(const Defines&)> compile) : compile_(std::move(compile)) {}

  Variant& with(const Defines& defines) {
    const auto found = made_.find(defines);
    return found != made_.end() ? found->second : made_.try_emplace(defines, compile_(defines)).first->second;
  }

 private:
  std::function<ProgramPtr(const Defines&)> compile_;
  std::map<Defines, Variant> made_;
};

}  // namespace lightwell::gl
