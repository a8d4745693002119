#version 450 core
layout(location = 1) uniform float radius;
layout(location = 3) uniform vec3 marker_color;
flat in vec2 center;
flat in float opacity;
out vec4 color;

void main() {
    float away = length(gl_FragCoord.xy - center);
    float rim = max(radius / 5, 1);
    float in_sign = clamp(radius + 0.5 - away, 0, 1), in_rim = clamp(away - (radius - rim) + 0.5, 0, 1);
    color = vec4(mix(marker_color, vec3(1), in_rim), in_sign * opacity);
}
