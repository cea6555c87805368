// `condition ? yes : no` as a function. What is written with it instead of branches compiles as C++ for the lanes of a
// processor as well: LANES, see renderer/lanes/glsl.h, which has its own.
#ifndef LANES
float select(bool condition, float yes, float no) { return condition ? yes : no; }
vec3 select(bool condition, vec3 yes, vec3 no) { return condition ? yes : no; }
#endif
