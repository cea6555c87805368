#include "server/command_line/scene_argument.h"

#include <cstdio>
#include <string_view>

#include "renderer/scene/builtin.h"
#include "renderer/scene/gltf/load_gltf.h"

namespace lightwell {

namespace {

constexpr std::string_view kBuiltinPrefix = "builtin:";

// The loader names the glTF object; the file is named here, unless it is that already.
Error error_in(const std::string& scene, Error error) {
  if (error.where.find(scene) == std::string::npos)
    error.where = error.where.empty() ? scene : scene + ": " + error.where;
  return error;
}

}  // namespace

Result<Scene> load_scene_argument(const std::string& name, const EnvironmentChoice& environment) {
  const bool is_builtin = name.starts_with(kBuiltinPrefix);
  Result<Scene> scene =
      is_builtin ? builtin_scene(std::string_view(name).substr(kBuiltinPrefix.size())) : load_gltf(name);
  if (!scene) return error_in(name, scene.error());
  for (const std::string& warning : scene->warnings)
    std::fprintf(stderr, "lightwell: %s: warning: %s\n", name.c_str(), warning.c_str());
  if (const Status applied = apply_environment(environment, scene->environment); !applied) return applied.error();
  if (!environment.is_dark() && add_default_light(*scene))
    std::fprintf(stderr, "lightwell: %s %s (--environment-strength 0 leaves it as it is)\n", name.c_str(),
                 scene->lights.empty() ? "has no light but what glows in it; a faint sky was added"
                                       : "brings no light; a soft sky and a sun were added");
  return scene;
}

}  // namespace lightwell
