// The scenes this server knows by name: the built-in ones, the one from the command line, and what clients upload.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>

#include "protocol/messages.h"
#include "renderer/scene/gltf/load_gltf.h"
#include "server/scenes/staged_scene.h"
#include "server/serve.h"

namespace lightwell {

/// Thread-safe. Scenes are immutable and shared: who holds one keeps it, whatever happens to its name.
class SceneStore {
 public:
  explicit SceneStore(const ServeLimits& limits) : limits_(limits) {}

  /// Makes all built-in scenes that are not there yet.
  void add_builtin_scenes();
  /// Loads what the command line names: builtin:NAME or a file, which is known by its stem from then on.
  /// Gives that name. Sessions that name no scene open it. It stands in `environment`.
  Result<std::string> add_from_command_line(const std::string& scene, const EnvironmentChoice& environment = {});

  struct Stored {
    protocol::SceneEntry entry;
    bool created = false;  // not replaced
  };
  /// Parses a .glb and stores it under a name; long work, no thread but the caller waits. All or nothing.
  protocol::Decoded<Stored> upload(const std::string& name, std::span<const std::byte> glb);

  /// Problem: 404 if there is none, 409 if it is built in.
  std::optional<protocol::Problem> remove(const std::string& name);

  std::shared_ptr<const StagedScene> find(const std::string& name) const;

  /// A scene with where it comes from.
  struct Source {
    std::shared_ptr<const StagedScene> scene;
    std::shared_ptr<const std::vector<std::byte>> glb;  // the upload; null for others
  };
  std::optional<Source> source(const std::string& name) const;

  /// How many uploads there are, and their bytes together.
  std::pair<std::size_t, std::uint64_t> uploads() const;
  /// First the one from the command line: what a viewer opens; then the built-in ones; then by name.
  std::vector<protocol::SceneEntry> entries() const;

 private:
  struct Entry {
    protocol::SceneEntry entry;
    std::shared_ptr<const StagedScene> scene;
    std::shared_ptr<const std::vector<std::byte>> glb;  // as it was uploaded; null: it was not
  };

  Status add_builtin(const std::string& name, const EnvironmentChoice& environment = {});
  std::optional<protocol::Problem> refuse_upload(const std::string& name, std::uint64_t bytes) const;

  const ServeLimits limits_;
  mutable std::mutex mutex_;
  std::map<std::string, Entry> scenes_;
  std::string first_;  // from the command line
};

/// What an upload may have.
LoadLimits load_limits(const ServeLimits& limits);

/// A scene from a file, ready to be shown: with `default_light`, lit if it brings no light of its own; what was left
/// out is in the log.
std::shared_ptr<const StagedScene> stage_upload(Scene scene, const std::string& name, bool default_light = true);

/// There is no scene of that name: 404 where it is the resource, 422 where a body names it.
protocol::Problem no_such_scene(const std::string& name, int status, std::string pointer = {});

}  // namespace lightwell
