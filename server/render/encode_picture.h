// A rendered frame as an image file in memory.
#pragma once

#include <string>

#include "protocol/messages.h"
#include "renderer/renderer.h"

namespace lightwell {

/// JPEG (quality 95, 4:4:4) and PNG of what a display shows, EXR of the linear light: the frame must hold it. The same
/// frame gives the same bytes.
Result<std::string> encode_picture(const Frame& frame, protocol::ImageFormat format);

}  // namespace lightwell
