// The module with libavcodec in it.
#pragma once

#include "server/video/codecs/codecs.h"

namespace lightwell {

/// The module's functions, loaded by the first call; kUnsupported in a build without them, kInternal where they
/// cannot be loaded. Thread-safe.
Result<const video_codecs::Table*> video_codecs_table();

}  // namespace lightwell
