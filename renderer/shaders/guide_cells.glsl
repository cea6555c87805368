// Cells of space for photon guides, see renderer/passes/photon_guides.h: told apart by where they are and which way a
// surface in them faces. Two that share a place in the table mix their guides, which costs noise and no more. Needs
// bindings, sampling.

uniform float guide_cell_m;

uint guide_cell(vec3 position_ws, vec3 normal_ws) {
  const vec3 size = abs(normal_ws);
  const uint axis = size.x > size.y && size.x > size.z ? 0u : size.y > size.z ? 1u : 2u;
  const uint side = normal_ws[axis] < 0.0 ? 1u : 0u;
  return hash(uvec3(ivec3(floor(position_ws / guide_cell_m))) + 2u * axis + side) & uint(GUIDE_CELLS - 1);
}
