// Filters shadow moments: a box of 2 x 2 texels into a map of half the side, or one direction of a box within such a map.
layout(binding = 0) uniform sampler2D moments;  // bilinear
layout(location = 0) out vec2 filtered;

uniform ivec2 direction;  // zero: halve the side
uniform int radius;
uniform vec2 texel_size;  // of what is written, in uv

void main() {
  vec2 sum = vec2(0.0);
  for (int i = -radius; i <= radius; ++i)
    sum += textureLod(moments, (gl_FragCoord.xy + vec2(i * direction)) * texel_size, 0.0).rg;
  filtered = sum / float(2 * radius + 1);
}
