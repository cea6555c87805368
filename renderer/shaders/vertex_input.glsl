// What DeviceScene's vertex array feeds to a vertex shader. Needs scene_data. The instance comes as attributes that
// advance per instance: a software device fetches them once a draw, not once a vertex.

layout(location = 0) in vec3 position;
layout(location = 1) in uvec2 normal_tangent;  // packed as in Vertex
layout(location = 2) in vec4 uv;               // both sets
layout(location = 3) in vec4 color;
layout(location = 4) in vec4 instance_row_x;
layout(location = 5) in vec4 instance_row_y;
layout(location = 6) in vec4 instance_row_z;
layout(location = 7) in uvec4 instance_numbers;

Instance vertex_instance() {
  return Instance(vec4[3](instance_row_x, instance_row_y, instance_row_z), instance_numbers.x, instance_numbers.y,
                  instance_numbers.z, instance_numbers.w);
}
