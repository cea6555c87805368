// Appends to the HitList of renderer/tracing/tracer.h. Needs tracing/bindings.glsl.
layout(std430, binding = TRACE_BINDING_HIT_LIST) writeonly buffer HitListRays { uint hit_list[]; };
layout(std430, binding = TRACE_BINDING_HIT_DISPATCH) buffer HitListDispatch {
  uint hit_groups, one, one_too, hit_count, traced_anew;
};
void add_to_list(uint index) {
  const uint place = atomicAdd(hit_count, 1u);
  hit_list[place] = index;
  if (place % TRACE_GROUP_SIZE == 0u) atomicAdd(hit_groups, 1u);
}
