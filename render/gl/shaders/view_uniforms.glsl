// What holds for all surfaces of a view, in view space.
layout(std140, binding = 0) uniform ViewUniforms {
    mat4 clip_from_view;
    mat3 world_from_view;
    vec4 light_color;  // a: what is left of it beside the surroundings
    vec4 attenuation, light_position, light_direction;
    vec4 cone;
    vec4 harmonics[9];  // of the surroundings' light, in world space
};
