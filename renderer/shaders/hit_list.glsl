// The rays of a batch that hit something; the C++ side is HitList in renderer/tracing/tracer.h. Needs bindings.

layout(std430, binding = BINDING_HIT_DISPATCH) readonly buffer HitDispatch { uint hit_groups[3]; uint hit_count; };
layout(binding = UNIT_HIT_LIST) uniform usamplerBuffer hit_list;

// The ray with the place-th hit, place < hit_count.
uint hit_ray(uint place) { return texelFetch(hit_list, int(place)).x; }
