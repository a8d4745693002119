#pragma once

// OpenGL 4.5 core, whose entry points libOpenGL (GLVND) exports: no loader is needed.
#define GL_GLEXT_PROTOTYPES 1
#include <GL/glcorearb.h>
