// One direction of a box filter over shadow moments, of the whole array.
layout(local_size_x = 64, local_size_y = 1) in;

layout(rg32f, binding = 0) writeonly uniform image2DArray filtered;
layout(binding = 0) uniform sampler2DArray moments;

uniform ivec2 direction;
uniform int radius;

void main() {
  const ivec3 texel = ivec3(gl_GlobalInvocationID);
  const ivec2 size = imageSize(filtered).xy;
  if (any(greaterThanEqual(texel.xy, size))) return;
  vec2 sum = vec2(0.0);
  for (int i = -radius; i <= radius; ++i)
    sum += texelFetch(moments, ivec3(clamp(texel.xy + i * direction, ivec2(0), size - 1), texel.z), 0).rg;
  imageStore(filtered, texel, vec4(sum / float(2 * radius + 1), 0.0, 0.0));
}
