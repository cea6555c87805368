// What has been edited since a scene was chosen, as edits that give the same scene again.
#pragma once

#include <memory>

#include "protocol/messages.h"

namespace lightwell {

inline constexpr std::size_t kMostKeptEdits = 4096;

/// `all` and then `more`, both of which a scene has taken. Tests are left out; edits that replace what the last ones
/// replaced, as those of a handle that is dragged do, stand in their place. Null if more than kMostKeptEdits are left.
std::shared_ptr<const protocol::Edits> with_edits(const protocol::Edits& all, const protocol::Edits& more);

}  // namespace lightwell
