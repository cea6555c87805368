// Between what travels (protocol) and what the renderer takes: settings, cameras, lights, errors.
#pragma once

#include <optional>

#include "protocol/messages.h"
#include "renderer/renderer.h"
#include "server/serve.h"

namespace lightwell {

/// `base` with what `spec` gives. A name the renderer does not know, a value out of its range or over a limit is a
/// problem whose pointer is `pointer` and the member.
protocol::Decoded<Settings> with_spec(const Settings& base, const protocol::SettingsSpec& spec, glm::ivec2 size_px,
                                      const ServeLimits& limits, const std::string& pointer);

/// A problem, its pointer `pointer`/width or `pointer`/height, if a picture of that size is over the limits.
std::optional<protocol::Problem> check_size(glm::ivec2 size_px, const ServeLimits& limits, const std::string& pointer);

/// All members given.
protocol::SettingsSpec spec_of(const Settings& settings);

/// An error as a problem document: what was given is wrong (422), missing (404), too large (413), or our fault (5xx,
/// whose text tells nothing of our insides).
protocol::Problem problem_of(const Error& error, std::string pointer = {});

/// `scene` with all edits, or a problem (422, 413 over a limit) whose pointer is that of the edit in a body's `edits`.
protocol::Decoded<Scene> edited(const Scene& scene, const protocol::Edits& edits, const ServeLimits& limits);

/// A camera at `eye` that looks at `target`, +Y up.
PlacedCamera placed(const protocol::FreeCamera& camera);

/// Where a camera stands and looks; `center` of what it looks at decides how far its target is away.
protocol::FreeCamera view_of(const PlacedCamera& camera, const glm::vec3& center);

protocol::Vector3 vector_of(const glm::vec3& v);

}  // namespace lightwell
