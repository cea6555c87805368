// The scene that a built glTF file gives, for tests of what is loaded.
#pragma once

#include <gtest/gtest.h>

#include <utility>

#include "tests/unit/gltf_builder.h"

namespace lightwell {

/// What was built, loaded; a refusal fails the test.
inline Scene loaded(const GltfBuilder& builder, const LoadLimits& limits = {}) {
  Result<Scene> scene = builder.load(limits);
  if (!scene) {
    ADD_FAILURE() << scene.error().message();
    return {};
  }
  return std::move(*scene);
}

}  // namespace lightwell
