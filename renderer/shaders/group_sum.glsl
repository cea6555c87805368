// The sum of a work group of 64, in an order of its own: the same in every run. Valid in invocation 0.

shared vec2 group_sums[64];

vec2 group_sum(vec2 value) {
  const uint here = gl_LocalInvocationIndex;
  group_sums[here] = value;
  barrier();
  for (uint others = 32u; others > 0u; others /= 2u) {
    if (here < others) group_sums[here] += group_sums[here + others];
    barrier();
  }
  return group_sums[0];
}
