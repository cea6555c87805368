// expected_cost() of bvh.h, by a single work group: what tells whether a hierarchy should be built anew. The root is the
// first of its nodes, which stand together.
#include "tracing/refit.glsl"

layout(std430, binding = TRACE_BINDING_REFIT_COST) writeonly buffer Cost { float cost; };

uniform uint first_node;

shared float sums[64];

float area(Box box) {
  const vec3 size = max(box.most - box.least, vec3(0.0));
  return 2.0 * (size.x * size.y + size.y * size.z + size.z * size.x);
}

float child_cost(uint child) { return is_leaf(child) ? TRACE_ITEM_COST * float(leaf_count(child)) : TRACE_NODE_COST; }

void main() {
  const uint own = gl_LocalInvocationID.x;
  float sum = 0.0;
  for (uint node = own; node < count; node += 64u) {
    const Box[2] boxes = boxes_of(first_node + node);
    const uvec2 children = node_words[4u * (first_node + node) + 3u].xy;
    sum += child_cost(children.x) * area(boxes[0]) + child_cost(children.y) * area(boxes[1]);
  }
  sums[own] = sum;
  for (uint reach = 32u; reach > 0u; reach /= 2u) {
    barrier();
    if (own < reach) sums[own] += sums[own + reach];
  }
  if (own != 0u) return;
  const Box[2] boxes = boxes_of(first_node);
  const float whole = area(joined(boxes[0], boxes[1]));
  cost = whole > 0.0 ? TRACE_NODE_COST + sums[0] / whole : 0.0;
}
