// What holds for all surfaces of a view, in view space.
layout(std140, binding = 0) uniform ViewUniforms {
    mat4 clip_from_view;
    mat3 world_from_view;
    vec4 light_color, attenuation, light_position, light_direction;
    vec4 cone;
};
