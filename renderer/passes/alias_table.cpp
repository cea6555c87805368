#include "renderer/passes/alias_table.h"

#include <algorithm>
#include <numeric>

namespace lightwell {

std::vector<AliasEntry> make_alias_table(std::span<const double> weights) {
  // Scaled by the greatest first: a sum of numbers near the end of the range would be infinite.
  const double greatest = weights.empty() ? 0.0 : *std::max_element(weights.begin(), weights.end());
  if (!(greatest > 0.0)) return {};
  std::vector<double> share(weights.size());
  std::transform(weights.begin(), weights.end(), share.begin(), [&](double w) { return w / greatest; });
  const double sum = std::accumulate(share.begin(), share.end(), 0.0);
  const auto count = static_cast<double>(weights.size());

  std::vector<AliasEntry> table(weights.size());
  std::vector<std::uint32_t> small, large;
  for (std::uint32_t i = 0; i < table.size(); ++i) {
    table[i].probability = static_cast<float>(share[i] / sum);
    table[i].alias = i;
    share[i] *= count / sum;  // 1 is an entry's fair share
    (share[i] < 1.0 ? small : large).push_back(i);
  }
  while (!small.empty() && !large.empty()) {
    const std::uint32_t less = small.back(), more = large.back();
    small.pop_back();
    table[less].threshold = static_cast<float>(share[less]);
    table[less].alias = more;
    share[more] -= 1.0 - share[less];
    if (share[more] >= 1.0) continue;
    large.pop_back();
    small.push_back(more);
  }
  // Rounding leaves some that are full but for the last bit; one that weighs nothing must still never be chosen.
  const auto heaviest = std::max_element(weights.begin(), weights.end()) - weights.begin();
  for (const std::uint32_t left : small)
    if (table[left].probability == 0.0f) {
      table[left].threshold = 0.0f;
      table[left].alias = static_cast<std::uint32_t>(heaviest);
    }
  for (AliasEntry& entry : table) entry.alias_probability = table[entry.alias].probability;
  return table;
}

}  // namespace lightwell
