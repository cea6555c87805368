// What g_buffer.vert hands on. Needs seen_point.

in vec3 world_position;
in vec3 world_normal;
#ifdef HAS_TEXTURES
in vec4 world_tangent;
in vec4 texture_uv;
in vec4 vertex_color_factor;
#endif
flat in uint material_index;
#ifdef MOTION
in vec3 displacement_ws;
#endif

SeenPoint seen_point() {
  SeenPoint seen;
  seen.material = material_index;
  seen.position_ws = world_position;
  seen.at = plain_attributes(normalize(world_normal));
  seen.footprint = vec2(0.0);
#ifdef HAS_TEXTURES
  seen.at.tangent_ws = world_tangent.xyz;
  seen.at.handedness = world_tangent.w;
  seen.at.uv0 = texture_uv.xy;
  seen.at.uv1 = texture_uv.zw;
  seen.at.color = vertex_color_factor;
  seen.footprint = footprint_of(dFdx(texture_uv), dFdy(texture_uv));
#endif
  seen.geometric_normal_ws = cross(dFdx(world_position), dFdy(world_position));
#ifdef FILTER_SPECULAR
  seen.normal_across = dFdx(seen.at.normal_ws);
  seen.normal_down = dFdy(seen.at.normal_ws);
#endif
#ifdef MOTION
  seen.displacement_ws = displacement_ws;
#endif
  return seen;
}
