// From the optical depths of clear_layers.frag to what a light sends through: the mean over the texels that the moments of
// depth are filtered over.
layout(binding = 0) uniform sampler2D clear_layers;
layout(location = 0) out vec4 tint;  // a: the least depth of the surfaces, a texel beyond their edges as well

uniform int texels_per_texel;  // of each side: 2 where the side is halved, else 1
uniform int radius;            // of the box, in texels of what is written

void main() {
  const ivec2 last = textureSize(clear_layers, 0) - 1;
  const ivec2 first = (ivec2(gl_FragCoord.xy) - radius) * texels_per_texel;
  const int side = (2 * radius + 1) * texels_per_texel;
  vec3 sum = vec3(0.0);
  float nearest = 1.0;
  for (int y = -1; y <= side; ++y)
    for (int x = -1; x <= side; ++x) {
      const vec4 layers = texelFetch(clear_layers, clamp(first + ivec2(x, y), ivec2(0), last), 0);
      const bool inside = min(x, y) >= 0 && max(x, y) < side;
      if (inside) sum += exp(-max(layers.rgb, 0.0));
      nearest = min(nearest, layers.a);
    }
  tint = vec4(sum / float(side * side), nearest);
}
