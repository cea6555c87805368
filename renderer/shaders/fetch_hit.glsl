// Reading rays and hit records wide: a software device fetches a texel of four words as fast as one word. Needs bindings,
// ray.

layout(binding = UNIT_RAYS) uniform samplerBuffer ray_texels;  // 2 texels a ray
layout(binding = UNIT_HITS) uniform usamplerBuffer hit_words;  // 4 words a texel, 5 words a hit

Ray fetch_ray(int index) {
  const vec4 origin = texelFetch(ray_texels, 2 * index);
  const vec4 direction = texelFetch(ray_texels, 2 * index + 1);
  return Ray(origin.xyz, origin.w, direction.xyz, direction.w);
}

// Two wide fetches in place of five narrow ones: a record begins at any of a texel's words.
Hit fetch_hit(int index) {
  const int word = 5 * index;
  const uvec4 a = texelFetch(hit_words, word >> 2);
  const uvec4 b = texelFetch(hit_words, (word >> 2) + 1);
  const int shift = word & 3;
  const uvec4 once = uvec4(a.yzw, b.x);
  const uvec4 twice = uvec4(a.zw, b.xy);
  const uvec4 thrice = uvec4(a.w, b.xyz);
  const uvec4 first = shift < 2 ? (shift == 0 ? a : once) : (shift == 2 ? twice : thrice);
  const uint last = shift < 2 ? (shift == 0 ? b.x : b.y) : (shift == 2 ? b.z : b.w);
  return Hit(uintBitsToFloat(first.x), first.y, first.z, uintBitsToFloat(first.w), uintBitsToFloat(last));
}

// Of the hit alone; negative: a miss.
float fetch_distance(int index) { return uintBitsToFloat(texelFetch(hit_words, 5 * index >> 2)[5 * index & 3]); }
