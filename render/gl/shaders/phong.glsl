// The light at a point, and Phong's equation, for the stage that evaluates it. The eye is the origin. After
// view_uniforms.glsl; the light is a HEADLIGHT, a POINT, DIRECTIONAL or a SPOT.

float attenuated(float d) { return 1 / max(dot(attenuation.xyz, vec3(1, d, d * d)), 1e-6); }

// smoothstep of the cosine. What it is short of 1 is half the square of a difference, which keeps its digits in
// the narrowest cone.
float in_cone(vec3 from_light) {
    vec3 off = from_light - light_direction.xyz;
    float t = clamp((cone.y - dot(off, off) / 2) / max(cone.y - cone.x, 1e-12), 0, 1);
    return t * t * (3 - 2 * t);
}

// The direction to the light, and how much of it arrives where the eye is at a distance d.
vec4 incident_light(vec3 at, vec3 to_eye, float d) {
#if defined(HEADLIGHT)
    vec3 to_light = to_eye;
    float intensity = attenuated(d);
#elif defined(DIRECTIONAL)
    vec3 to_light = -light_direction.xyz;
    float intensity = 1;
#else
    vec3 light_offset = light_position.xyz - at;
    float light_distance = length(light_offset);
    vec3 to_light = light_offset / max(light_distance, 1e-30);
    float intensity = attenuated(light_distance);
#ifdef SPOT
    intensity *= in_cone(-to_light);
#endif
#endif
    return vec4(to_light, intensity);
}

// How much light the matte and the shiny part of a surface send to the eye, which is at a distance d.
vec2 phong(vec3 at, vec3 n, vec3 to_eye, float d, float shininess) {
    vec4 light = incident_light(at, to_eye, d);
    vec3 to_light = light.xyz;
    float intensity = light.w;
    float lambert = max(dot(to_light, n), 0);
    float highlight = max(dot(reflect(-to_light, n), to_eye), 1e-30);  // pow(0, 0) is undefined
    return lambert * intensity * vec2(1, pow(highlight, shininess));
}
