// The module with OpenImageIO in it.
#pragma once

#include "renderer/image_io/codecs/codecs.h"

namespace lightwell {

/// The module's functions; as load_image_codecs().
Result<const codecs::Table*> image_codecs();

}  // namespace lightwell
