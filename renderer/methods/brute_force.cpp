#include "renderer/methods/brute_force.h"

#include <string>

#include "renderer/passes/indirect_map_grid.h"

namespace lightwell {

namespace {

// A second of four cores of a processor; a GPU tries a hundred times as many.
constexpr std::uint64_t kMostTestsBySoftware = 400'000'000, kMostTestsByGpu = 40'000'000'000;

}  // namespace

Status check_brute_force(const Settings& settings, glm::ivec2 size_px, std::uint64_t triangles, bool software) {
  const glm::uvec2 map_size_px(indirect_map_size(size_px, settings.indirect_size));
  const std::uint64_t rays =
      std::uint64_t{map_size_px.x} * map_size_px.y * static_cast<std::uint64_t>(settings.samples);
  const std::uint64_t most = software ? kMostTestsBySoftware : kMostTestsByGpu;
  if (settings.bounces == 0 || triangles <= most / rays) return Done{};
  return Error{ErrorKind::kTooLarge, "brute-force",
               std::to_string(rays) + " rays that try " + std::to_string(triangles) +
                   " triangles each are more than the " + std::to_string(most) +
                   " tests a frame may have: take fewer samples or a smaller indirect map"};
}

}  // namespace lightwell
