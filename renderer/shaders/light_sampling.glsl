// Sampling all that lights a scene by power; the C++ side is renderer/passes/light_table.h. Needs bindings, packing,
// sampling, lights, scene_data, environment, and textures with ALL_TEXTURES.
// LIGHTS_PUNCTUAL, LIGHTS_TRIANGLES, LIGHTS_ENVIRONMENT: which kinds there may be.

layout(binding = UNIT_LIGHT_TABLE) uniform usamplerBuffer light_table;             // 4 texels a light
layout(binding = UNIT_LIGHT_CHOICES) uniform usamplerBuffer light_choices;         // an alias entry a texel
layout(binding = UNIT_INSTANCE_LIGHTS) uniform usamplerBuffer instance_lights;     // first light + 1; 0: emits nothing

uniform uint table_lights;             // in the table of all
uniform uint table_punctual_lights;    // in the table of punctual ones, which follows; then come the environment's cells
uniform uint table_sized_first;        // where the table of lights with a size begins, with an entry for every light
uniform float table_sized_share;       // the probability of choosing one with a size among all
uniform ivec2 environment_cells;
uniform float environment_probability; // of choosing it among all

const uint kLightTriangle = 3u, kLightEnvironment = 4u;  // punctual ones are 0 to 2, see lights.glsl

const float kInfinitelyFar = 1e30;  // metres

struct TableSample {
  vec3 to_light_ws;  // unit
  float distance_m;
  vec3 value;        // irradiance (punctual) or radiance over density; 0: nothing there
  float pdf;         // over solid angle; 0 for punctual lights, which no ray can hit
};

struct Choice {
  uint index;
  float probability;
};

// Walker's alias method in the `count` entries from `first` on.
Choice choose(uint first, uint count, float u) {
  const float scaled = u * float(count);
  const uint entry = min(uint(scaled), count - 1u);
  const uvec4 words = texelFetch(light_choices, int(first + entry));
  const bool itself = scaled - float(entry) < uintBitsToFloat(words.x);
  return itself ? Choice(entry, uintBitsToFloat(words.z)) : Choice(words.y, uintBitsToFloat(words.w));
}

#ifdef LIGHTS_TRIANGLES
#ifdef ALL_TEXTURES
vec3 emissive_texel(uint instance_index, uint triangle, vec3 weight) {
  const Instance instance = fetch_instance(instance_index);
  const TextureUse use = fetch_material(instance.material).emissive_texture;
  if (use.slot == 0u) return vec3(1.0);
  const uvec4 corners = triangle_corners(instance, triangle);
  const Vertex a = fetch_vertex(corners.x);
  const Vertex b = fetch_vertex(corners.y);
  const Vertex c = fetch_vertex(corners.z);
  return sample_color_texture(use, a.uv0 * weight.x + b.uv0 * weight.y + c.uv0 * weight.z,
                              a.uv1 * weight.x + b.uv1 * weight.y + c.uv1 * weight.z, vec2(0.0)).rgb;
}
#endif

// A point of the triangle, uniform over its area; both sides emit.
TableSample sample_triangle(int first, vec4 corner, vec3 position_ws, vec2 u) {
  const vec4 edge_u = uintBitsToFloat(texelFetch(light_table, first + 1));
  const vec4 edge_v = uintBitsToFloat(texelFetch(light_table, first + 2));
  const vec4 radiance = uintBitsToFloat(texelFetch(light_table, first + 3));
  const float root = sqrt(u.x);
  const vec2 weight = vec2(root * (1.0 - u.y), root * u.y);
  const vec3 to_light = corner.xyz + weight.x * edge_u.xyz + weight.y * edge_v.xyz - position_ws;
  const float distance2 = max(dot(to_light, to_light), 1e-20);
  TableSample light;
  light.distance_m = sqrt(distance2);
  light.to_light_ws = to_light / light.distance_m;
  const float cosine = abs(dot(normalize(cross(edge_u.xyz, edge_v.xyz)), light.to_light_ws));
  light.pdf = radiance.w * distance2 / max(cosine, 1e-6);
  light.value = cosine > 1e-6 ? radiance.rgb / light.pdf : vec3(0.0);
#ifdef ALL_TEXTURES
  light.value *= emissive_texel(floatBitsToUint(edge_u.w), floatBitsToUint(edge_v.w),
                                vec3(1.0 - weight.x - weight.y, weight));
#endif
  return light;
}

// Density over solid angle with which sample_light gives a point of this triangle; 0 if it is no light of the table.
float triangle_pdf(uint instance, uint triangle, float distance_m, float cosine) {
  const uint first_light = texelFetch(instance_lights, int(instance)).x;
  const int texel = int(4u * (max(first_light, 1u) - 1u + triangle) + 3u);
  const float density = first_light == 0u ? 0.0 : uintBitsToFloat(texelFetch(light_table, texel).w);
  return density * distance_m * distance_m / max(abs(cosine), 1e-6);
}
#endif

#ifdef LIGHTS_ENVIRONMENT
float cell_solid_angle(int row) {
  const vec2 up = cos(kPi * vec2(float(row), float(row + 1)) / float(environment_cells.y));
  return (up.x - up.y) * (2.0 * kPi) / float(environment_cells.x);
}

TableSample sample_environment(float probability, vec2 u, float u_cell) {
  const uint cells = uint(environment_cells.x * environment_cells.y);
  const Choice cell = choose(table_lights + table_punctual_lights, cells, u_cell);
  const int row = int(cell.index) / environment_cells.x;
  const float column = float(int(cell.index) % environment_cells.x) + u.x;
  const vec2 up = cos(kPi * vec2(float(row), float(row + 1)) / float(environment_cells.y));
  TableSample light;
  light.to_light_ws = environment_direction(column / float(environment_cells.x), mix(up.x, up.y, u.y));
  light.distance_m = kInfinitelyFar;
  light.pdf = probability * cell.probability / cell_solid_angle(row);
  light.value = environment_radiance(light.to_light_ws) / max(light.pdf, 1e-30);
  return light;
}

float environment_pdf(vec3 direction_ws) {
  const vec2 uv = environment_uv(direction_ws);
  const ivec2 cell = clamp(ivec2(vec2(fract(uv.x), uv.y) * vec2(environment_cells)), ivec2(0), environment_cells - 1);
  const int entry = int(table_lights + table_punctual_lights) + cell.y * environment_cells.x + cell.x;
  return environment_probability * uintBitsToFloat(texelFetch(light_choices, entry).z) / cell_solid_angle(cell.y);
}
#endif

#ifdef LIGHTS_PUNCTUAL
TableSample sample_punctual(uvec4[4] record, float probability, vec3 position_ws) {
  Light light;
  light.position_ws = uintBitsToFloat(record[0].xyz);
  light.kind = record[0].w;
  light.direction_ws = uintBitsToFloat(record[1].xyz);
  light.inverse_range = uintBitsToFloat(record[1].w);
  light.intensity = uintBitsToFloat(record[2].xyz);
  light.spot_scale = uintBitsToFloat(record[2].w);
  light.spot_offset = uintBitsToFloat(record[3].w);
  const LightSample at = light_at(light, position_ws);
  return TableSample(at.to_light_ws, light.kind == 0u ? kInfinitelyFar : distance(light.position_ws, position_ws),
                     at.irradiance / probability, 0.0);
}
#endif

// A point of the chosen light, or what the light gives if it is punctual.
TableSample sample_chosen_light(Choice choice, vec3 position_ws, vec2 u, float u_cell) {
  TableSample light = TableSample(vec3(0.0, 1.0, 0.0), 0.0, vec3(0.0), 0.0);
  const int first = int(4u * choice.index);
  const uvec4 head = texelFetch(light_table, first);
#ifdef LIGHTS_TRIANGLES
  if (head.w == kLightTriangle) light = sample_triangle(first, uintBitsToFloat(head), position_ws, u);
#endif
#ifdef LIGHTS_ENVIRONMENT
  if (head.w == kLightEnvironment) light = sample_environment(choice.probability, u, u_cell);
#endif
#ifdef LIGHTS_PUNCTUAL
  if (head.w < kLightTriangle) {
    const uvec4 record[4] = uvec4[4](head, texelFetch(light_table, first + 1), texelFetch(light_table, first + 2),
                                     texelFetch(light_table, first + 3));
    light = sample_punctual(record, choice.probability, position_ws);
  }
#endif
  return light;
}

// One light of the table by its power and a point of it. `u` chooses the point, `u_choice` the light and `u_cell` a part
// of the environment. `punctual_only`: among these alone.
TableSample sample_light(vec3 position_ws, bool punctual_only, vec2 u, float u_choice, float u_cell) {
  const uint count = punctual_only ? table_punctual_lights : table_lights;
  if (count == 0u) return TableSample(vec3(0.0, 1.0, 0.0), 0.0, vec3(0.0), 0.0);
  return sample_chosen_light(choose(punctual_only ? table_lights : 0u, count, u_choice), position_ws, u, u_cell);
}

// The same among the lights that have a size. Densities of triangle_pdf() and environment_pdf() are then to be divided by
// table_sized_share. There must be such a light.
TableSample sample_sized_light(vec3 position_ws, vec2 u, float u_choice, float u_cell) {
  const Choice choice = choose(table_sized_first, table_lights, u_choice);
  TableSample light = sample_chosen_light(choice, position_ws, u, u_cell);
  if (light.distance_m < kInfinitelyFar) {  // a triangle: its record has the density among all
    light.pdf /= table_sized_share;
    light.value *= table_sized_share;
  }
  return light;
}
