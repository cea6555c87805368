// SHA-256, for names that content gives itself.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/scene/scene.h"

namespace lightwell {

/// A SHA-256 under way. Each piece is preceded by its length, so that no two lists of pieces are the same.
class Digest {
 public:
  Digest();
  ~Digest();
  Digest(const Digest&) = delete;
  Digest& operator=(const Digest&) = delete;

  void add(std::string_view text) { add_bytes(std::as_bytes(std::span(text))); }
  template <class T>
  void add(const std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    add_bytes(std::as_bytes(std::span(values)));
  }
  void add_bytes(std::span<const std::byte> bytes);

  /// 64 hexadecimal digits. Ends it.
  std::string hex();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Of everything in a scene that a picture depends on: object model, geometry, images, animations.
std::string scene_digest(const Scene& scene);

}  // namespace lightwell
