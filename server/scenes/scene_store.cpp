#include "server/scenes/scene_store.h"

#include <algorithm>
#include <filesystem>

#include "protocol/names.h"
#include "renderer/scene/builtin.h"
#include "server/convert.h"
#include "server/operations/log.h"

namespace lightwell {
namespace {

using protocol::make_problem;
using protocol::Problem;

constexpr std::string_view kBuiltinPrefix = "builtin:";

/// A file's stem as a scene name: lower case, other characters become "-".
std::string scene_name_of(const std::filesystem::path& path) {
  std::string name = path.stem().string().substr(0, 64);
  for (char& c : name) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    const bool good = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
    if (!good) c = '-';
  }
  return name.empty() ? "scene" : name;
}

}  // namespace

void SceneStore::add_builtin_scenes() {
  for (const std::string& name : builtin_scene_names()) static_cast<void>(add_builtin(name));  // in their own light
}

Status SceneStore::add_builtin(const std::string& name, const EnvironmentChoice& environment) {
  if (find(name)) return Done{};
  Result<Scene> scene = builtin_scene(name);
  if (!scene) return scene.error();
  if (const Status applied = apply_environment(environment, scene->environment); !applied) return applied;
  auto stage = std::make_shared<const StagedScene>(std::move(scene).value());
  Entry entry{stage->entry(name, true), stage, nullptr};
  std::lock_guard lock(mutex_);
  scenes_.emplace(name, std::move(entry));
  return Done{};
}

Result<std::string> SceneStore::add_from_command_line(const std::string& scene, const EnvironmentChoice& environment) {
  if (scene.starts_with(kBuiltinPrefix)) {
    const std::string name = scene.substr(kBuiltinPrefix.size());
    if (const Status added = add_builtin(name, environment); !added) return added.error();
    std::lock_guard lock(mutex_);
    return first_ = name;
  }
  Result<Scene> loaded = load_gltf(scene);
  if (!loaded) return loaded.error();
  if (const Status applied = apply_environment(environment, loaded->environment); !applied) return applied.error();
  std::string name = scene_name_of(scene);
  const std::vector<std::string>& builtin = builtin_scene_names();
  if (std::find(builtin.begin(), builtin.end(), name) != builtin.end()) name = name.substr(0, 59) + "-file";
  auto stage = stage_upload(std::move(loaded).value(), name, !environment.is_dark());
  Entry entry{stage->entry(name, false), stage, nullptr};
  std::lock_guard lock(mutex_);
  scenes_.insert_or_assign(name, std::move(entry));
  return first_ = name;
}

std::optional<Problem> SceneStore::refuse_upload(const std::string& name, std::uint64_t bytes) const {
  const auto found = scenes_.find(name);
  if (found != scenes_.end() && found->second.entry.builtin)
    return make_problem(409, "the scene \"" + name + "\" is built in and cannot be replaced");
  std::uint64_t all_bytes = bytes;
  int count = 1;
  for (const auto& [other, entry] : scenes_) {
    if (!entry.glb || other == name) continue;
    all_bytes += entry.glb->size();
    ++count;
  }
  if (count > limits_.max_scenes)
    return make_problem(409, "there are " + std::to_string(limits_.max_scenes) +
                                 " uploaded scenes already, as many as this server keeps; delete one first");
  if (all_bytes > limits_.max_scene_bytes)
    return make_problem(413, "all uploaded scenes together may have at most " +
                                 std::to_string(limits_.max_scene_bytes) + " bytes; delete one first");
  return {};
}

protocol::Decoded<SceneStore::Stored> SceneStore::upload(const std::string& name, std::span<const std::byte> glb) {
  {
    std::lock_guard lock(mutex_);  // before the long work, so that what must fail fails early
    if (auto problem = refuse_upload(name, glb.size())) return *problem;
  }
  Result<Scene> scene = load_glb(glb, load_limits(limits_));
  if (!scene) return problem_of(scene.error());
  auto stage = stage_upload(std::move(scene).value(), name);
  Entry entry{stage->entry(name, false), stage, std::make_shared<const std::vector<std::byte>>(glb.begin(), glb.end())};

  std::lock_guard lock(mutex_);  // and again: others may have stored theirs in the meantime
  if (auto problem = refuse_upload(name, glb.size())) return *problem;
  Stored stored{entry.entry, false};
  stored.created = scenes_.insert_or_assign(name, std::move(entry)).second;
  return stored;
}

std::optional<Problem> SceneStore::remove(const std::string& name) {
  std::lock_guard lock(mutex_);
  const auto found = scenes_.find(name);
  if (found == scenes_.end()) return no_such_scene(name, 404);
  if (found->second.entry.builtin) return make_problem(409, "the scene \"" + name + "\" is built in");
  scenes_.erase(found);
  return {};
}

std::shared_ptr<const StagedScene> SceneStore::find(const std::string& name) const {
  std::lock_guard lock(mutex_);
  const auto found = scenes_.find(name);
  return found == scenes_.end() ? nullptr : found->second.scene;
}

std::optional<SceneStore::Source> SceneStore::source(const std::string& name) const {
  std::lock_guard lock(mutex_);
  const auto found = scenes_.find(name);
  if (found == scenes_.end()) return {};
  return Source{found->second.scene, found->second.glb};
}

std::pair<std::size_t, std::uint64_t> SceneStore::uploads() const {
  std::lock_guard lock(mutex_);
  std::pair<std::size_t, std::uint64_t> sum{0, 0};
  for (const auto& [name, entry] : scenes_) {
    if (!entry.glb) continue;
    ++sum.first;
    sum.second += entry.glb->size();
  }
  return sum;
}

std::vector<protocol::SceneEntry> SceneStore::entries() const {
  std::lock_guard lock(mutex_);
  std::vector<protocol::SceneEntry> entries;
  for (const auto& [name, entry] : scenes_) entries.push_back(entry.entry);
  const auto rank = [this](const protocol::SceneEntry& entry) {
    return entry.name == first_ ? 0 : entry.builtin ? 1 : 2;
  };
  std::stable_sort(entries.begin(), entries.end(), [&](const auto& a, const auto& b) { return rank(a) < rank(b); });
  return entries;
}

LoadLimits load_limits(const ServeLimits& limits) {
  LoadLimits load;
  load.max_file_bytes = limits.max_upload_bytes;
  load.max_triangles = limits.max_triangles;
  load.max_texture_bytes = limits.max_texture_bytes;
  return load;
}

std::shared_ptr<const StagedScene> stage_upload(Scene scene, const std::string& name, bool default_light) {
  for (const std::string& warning : scene.warnings)
    log_event(LogLevel::kWarning, "scene_warning", {{"scene", name}, {"warning", warning}});
  if (default_light && add_default_light(scene)) log_event(LogLevel::kInfo, "default_light_added", {{"scene", name}});
  return std::make_shared<const StagedScene>(std::move(scene));
}

Problem no_such_scene(const std::string& name, int status, std::string pointer) {
  return make_problem(status, "there is no scene \"" + name + "\"", std::move(pointer));
}

}  // namespace lightwell
