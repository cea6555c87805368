// A source of pictures that tells the metrics of its device's memory.
#pragma once

#include "server/operations/metrics.h"
#include "server/render/picture_source.h"

namespace lightwell {

/// The same, and after a picture, once a second at most, `metrics` learn the device's memory. `metrics` outlive it.
MakePictureSource with_memory_meter(MakePictureSource make_source, Metrics& metrics);

}  // namespace lightwell
