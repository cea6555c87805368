// Storage bindings of the compute tracer, read by C++ and GLSL alike: preprocessor lines only.
#define TRACE_BINDING_RAYS 0
#define TRACE_BINDING_RESULTS 1
#define TRACE_BINDING_NODES 2
#define TRACE_BINDING_TRIANGLES 3
#define TRACE_BINDING_GROUPS 4
#define TRACE_BINDING_COVERAGE 5
#define TRACE_BINDING_CORNER_UVS 6
#define TRACE_BINDING_ALPHA 7
#define TRACE_BINDING_HIT_LIST 9
#define TRACE_BINDING_HIT_DISPATCH 10
#define TRACE_BINDING_PLACES 11
#define TRACE_BINDING_INSTANCES 12
#define TRACE_BINDING_PIXELS 13
#define TRACE_BINDING_DIRECTIONS 14
#define TRACE_BINDING_TESTS 15
#define TRACE_BINDING_REFIT_WORDS 11
#define TRACE_BINDING_POSITIONS 12
#define TRACE_BINDING_REFIT_COST 13

#define TRACE_GROUP_SIZE 64
// Levels of inner nodes, each of which may leave one entry on the traversal stack.
#define TRACE_TOP_LEVELS 24
#define TRACE_BOTTOM_LEVELS 40

// Relative costs of the surface-area heuristic: one visit of a node (two boxes) against one triangle.
#define TRACE_NODE_COST 1.2
#define TRACE_ITEM_COST 1.0
