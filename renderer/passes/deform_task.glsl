// What a work group of deform_vertices.comp and deform_triangles.comp has to do; the C++ side is deformer.cpp.

struct Task {
  uint first_group;  // of the dispatch
  uint count;        // vertices, or triangles
  uint first_source, first_target;
  uint source_vertex, target_vertex;  // the first ones, for triangles
  uint first_influence, first_matrix, last_joint;
  uint first_morph, morphs;
  uint padding;
};

layout(std430, binding = BINDING_DEFORM_TASKS) readonly buffer Tasks { Task tasks[]; };
layout(std430, binding = BINDING_DEFORM_GROUPS) readonly buffer Groups { uint group_tasks[]; };

Task own_task() { return tasks[group_tasks[gl_WorkGroupID.x]]; }

// Of the task's vertices or triangles, which is this invocation's: none from its count on.
uint own_number(Task task) { return (gl_WorkGroupID.x - task.first_group) * gl_WorkGroupSize.x + gl_LocalInvocationID.x; }
