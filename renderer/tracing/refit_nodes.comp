// Fits the boxes of nodes whose children are fitted already: a node for each invocation. `refit_words`: the nodes.
#include "tracing/refit.glsl"

Box box_of(uint child) {
  if (!is_leaf(child)) {
    const Box[2] boxes = boxes_of(child);
    return joined(boxes[0], boxes[1]);
  }
  const uint first = child & kFirstMask;
  Box box = Box(vec3(uintBitsToFloat(0x7f800000u)), vec3(uintBitsToFloat(0xff800000u)));
  for (uint word = 3u * first; word < 3u * (first + leaf_count(child)); ++word) {
    const vec3 corner = uintBitsToFloat(triangle_words[word].xyz);
    box = joined(box, Box(corner, corner));
  }
  return box;
}

void main() {
  if (gl_GlobalInvocationID.x >= count) return;
  const uint node = refit_words[first_word + gl_GlobalInvocationID.x];
  const uvec2 children = node_words[4u * node + 3u].xy;
  const Box left = box_of(children.x), right = box_of(children.y);
  node_words[4u * node] = floatBitsToUint(vec4(left.least, left.most.x));
  node_words[4u * node + 1u] = floatBitsToUint(vec4(left.most.yz, right.least.xy));
  node_words[4u * node + 2u] = floatBitsToUint(vec4(right.least.z, right.most));
}
