// What the programs of device_refit.cpp share. Hierarchies as traversal.glsl reads them: BvhNode is 4 uvec4,
// DeviceTriangle 3.
layout(local_size_x = 64) in;

#include "tracing/bindings.glsl"

layout(std430, binding = TRACE_BINDING_NODES) coherent buffer Nodes { uvec4 node_words[]; };
layout(std430, binding = TRACE_BINDING_TRIANGLES) coherent buffer Triangles { uvec4 triangle_words[]; };
layout(std430, binding = TRACE_BINDING_REFIT_WORDS) readonly buffer RefitWords { uint refit_words[]; };

uniform uint first_word;  // of this dispatch
uniform uint count;

// BvhChild.
const uint kLeafBit = 0x80000000u, kCountShift = 27u, kFirstMask = 0x07ffffffu;

bool is_leaf(uint child) { return (child & kLeafBit) != 0u; }
uint leaf_count(uint child) { return ((child & ~kLeafBit) >> kCountShift) + 1u; }

struct Box {
  vec3 least, most;
};

Box joined(Box a, Box b) { return Box(min(a.least, b.least), max(a.most, b.most)); }

// The boxes of both children.
Box[2] boxes_of(uint node) {
  const uvec4 a = node_words[4u * node], b = node_words[4u * node + 1u], c = node_words[4u * node + 2u];
  return Box[2](Box(uintBitsToFloat(a.xyz), uintBitsToFloat(uvec3(a.w, b.xy))),
                Box(uintBitsToFloat(uvec3(b.zw, c.x)), uintBitsToFloat(c.yzw)));
}
