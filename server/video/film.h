// Pictures as a film: H.264 in an MP4 file.
#pragma once

#include "server/video/codecs/codecs.h"

namespace lightwell {

using video_codecs::FilmEncoder;

/// A film of pictures that VideoEncoder::takes, so many a second (0.001..1000). The same pictures give the same bytes.
/// kUnsupported without an encoder.
Result<std::unique_ptr<FilmEncoder>> open_film(glm::ivec2 size_px, double fps);

}  // namespace lightwell
