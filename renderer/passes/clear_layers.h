// What lies before the opaque surfaces of a view and lets light through, summed up.
#pragma once

#include "renderer/gl/texture.h"
#include "renderer/passes/device_scene.h"

namespace lightwell {

/// Draws the scene by the program in use, a variant of clear_layers.frag, into a framebuffer of one RGBA32F texture:
/// optical depths add up in rgb, a keeps the least of all.
void draw_clear_layers(const DeviceScene& scene, const gl::Framebuffer& framebuffer);

}  // namespace lightwell
