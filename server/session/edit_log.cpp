#include "server/session/edit_log.h"

#include <algorithm>

namespace lightwell {
namespace {

using protocol::Edits;

bool replace_the_same(const nlohmann::json& a, const nlohmann::json& b) {
  return a.at("op") == "replace" && b.at("op") == "replace" && a.at("path") == b.at("path");
}

}  // namespace

std::shared_ptr<const Edits> with_edits(const Edits& all, const Edits& more) {
  Edits fresh = Edits::array();
  for (const auto& edit : more)
    if (edit.at("op") != "test") fresh.push_back(edit);
  Edits kept = all;
  const bool is_again = fresh.size() <= kept.size() &&
                        std::equal(fresh.begin(), fresh.end(),
                                   kept.end() - static_cast<Edits::difference_type>(fresh.size()), replace_the_same);
  if (is_again) kept.erase(kept.end() - static_cast<Edits::difference_type>(fresh.size()), kept.end());
  kept.insert(kept.end(), fresh.begin(), fresh.end());
  if (kept.size() > kMostKeptEdits) return nullptr;
  return std::make_shared<const Edits>(std::move(kept));
}

}  // namespace lightwell
