// Uploaded scenes on the disk, beside the work that needs them: an upload lives as long as its server, sequences and
// sessions may live longer.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "server/data/frame_files.h"
#include "server/scenes/scene_store.h"

namespace lightwell {

/// Thread-safe once all users are named.
class SceneFiles {
 public:
  /// data_dir/scenes/DIGEST. Throws std::runtime_error that names what cannot be made.
  SceneFiles(const std::string& data_dir, const SceneStore& scenes, const ServeLimits& limits);

  /// Sees to it that the scene can be found whatever becomes of this server; a scene that was not uploaded is another
  /// server's as well.
  Status keep(const SceneStore::Source& source) const;

  /// The scene as it was: this server's of that name, or the one kept. Problem: 409 if neither has this digest.
  protocol::Decoded<SceneStore::Source> find(const std::string& name, const std::string& digest) const;

  /// `uses` tells whether a digest's scene is still needed.
  void add_user(std::function<bool(const std::string& digest)> uses) { users_.push_back(std::move(uses)); }
  void remove_if_unused(const std::string& digest) const;

 private:
  const FrameFolder folder_;
  const SceneStore& scenes_;
  const ServeLimits limits_;
  std::vector<std::function<bool(const std::string&)>> users_;
};

}  // namespace lightwell
