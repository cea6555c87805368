// A rendered frame as the answer to a request: an image file, with what it cost in the header fields.
#pragma once

#include "renderer/renderer.h"
#include "server/http/message.h"

namespace lightwell::http {

/// Encodes on the calling thread. Server-Timing names each stage, in milliseconds.
Response picture_response(const Frame& frame, protocol::ImageFormat format);

}  // namespace lightwell::http
