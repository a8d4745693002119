#version 450 core
#include "local_position.glsl"
#include "clip_planes.glsl"
layout(location = 0) uniform mat4 clip_from_view;
layout(location = 1) uniform mat4 view_from_local;
invariant gl_Position;

void main() {
    vec3 local = local_position();
    clip_by_planes(local);
    gl_Position = clip_from_view * (view_from_local * vec4(local, 1));
}
