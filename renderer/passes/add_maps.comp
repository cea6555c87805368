// sum += bounce, texel by texel; the first bounce starts the sum.
layout(local_size_x = 8, local_size_y = 8) in;

layout(rgba32f, binding = 0) readonly uniform image2D bounce;
layout(rgba32f, binding = 1) uniform image2D sum;

uniform int first;

void main() {
  const ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, imageSize(sum)))) return;
  const vec4 added = imageLoad(bounce, texel);
  const vec3 before = first == 1 ? vec3(0.0) : imageLoad(sum, texel).rgb;
  imageStore(sum, texel, vec4(before + added.rgb, added.a));
}
