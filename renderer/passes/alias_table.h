// Choosing one of many in proportion to weights, in constant time: the alias method (Walker 1977; built after Vose
// 1991).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace lightwell {

/// One entry, as shaders/light_sampling.glsl reads it: a uniform choice among the entries, then either the entry itself
/// (with `threshold`) or its alias.
struct AliasEntry {
  float threshold = 1.0f;
  std::uint32_t alias = 0;
  float probability = 0.0f;        // of choosing this entry, over both ways
  float alias_probability = 0.0f;  // of choosing its alias
};
static_assert(sizeof(AliasEntry) == 16);

/// One entry per weight; weights are finite and not negative. Empty when there is none above 0.
std::vector<AliasEntry> make_alias_table(std::span<const double> weights);

}  // namespace lightwell
