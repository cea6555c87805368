#include "server/data/scene_files.h"

#include <algorithm>

#include "renderer/scene/gltf/load_gltf.h"
#include "server/convert.h"

namespace lightwell {
namespace {

constexpr const char* kFile = "scene.glb";

}  // namespace

SceneFiles::SceneFiles(const std::string& data_dir, const SceneStore& scenes, const ServeLimits& limits)
    : folder_(std::filesystem::path(data_dir) / "scenes"), scenes_(scenes), limits_(limits) {}

Status SceneFiles::keep(const SceneStore::Source& source) const {
  if (!source.glb) return Done{};
  const std::string& digest = source.scene->digest();
  if (std::filesystem::exists(folder_.path(digest, kFile))) return Done{};
  return folder_.write(digest, kFile, std::as_bytes(std::span(*source.glb)));
}

protocol::Decoded<SceneStore::Source> SceneFiles::find(const std::string& name, const std::string& digest) const {
  if (auto source = scenes_.source(name); source && source->scene->digest() == digest) return std::move(*source);
  const Result<std::string> file = folder_.read(digest, kFile);
  if (!file) return protocol::make_problem(409, "the scene \"" + name + "\" is gone, or is another now");
  const auto bytes = std::as_bytes(std::span(*file));
  Result<Scene> scene = load_glb(bytes, load_limits(limits_));
  if (!scene) return problem_of(scene.error());
  return SceneStore::Source{stage_upload(std::move(scene).value(), name),
                            std::make_shared<const std::vector<std::byte>>(bytes.begin(), bytes.end())};
}

void SceneFiles::remove_if_unused(const std::string& digest) const {
  const bool is_used = std::any_of(users_.begin(), users_.end(), [&](const auto& uses) { return uses(digest); });
  if (!is_used) folder_.remove(digest);
}

}  // namespace lightwell
