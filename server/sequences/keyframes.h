// A property's value at a time between its keys, as glTF 2.0 (appendix C) interpolates.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "protocol/sequence.h"

namespace lightwell {

/// The value at a time; the first or last one outside the keys. Rotations come out unit.
std::vector<double> value_at(const protocol::Keyframes& keyframes, double time_s);

/// The edits that set all properties to their values at a time.
protocol::Edits edits_at(const std::vector<protocol::Keyframes>& keyframes, double time_s);

/// The camera at a time: `camera` with what the keyframes of /eye, /target and /yfov say.
protocol::FreeCamera camera_at(protocol::FreeCamera camera, const std::vector<protocol::Keyframes>& keyframes,
                               double time_s);

}  // namespace lightwell
