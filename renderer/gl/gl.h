// OpenGL 4.5 core, linked directly through libOpenGL: no loader, no other GL header in the project.
#pragma once

#define GL_GLEXT_PROTOTYPES 1
#include <GL/glcorearb.h>
