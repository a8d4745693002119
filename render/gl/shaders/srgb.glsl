// The transfer curve of sRGB (IEC 61966-2-1).

vec3 linear_from_srgb(vec3 displayed) {
    vec3 curved = pow((max(displayed, 0) + 0.055) / 1.055, vec3(2.4));
    return mix(curved, displayed / 12.92, lessThanEqual(displayed, vec3(0.04045)));
}

// Values beyond 0 to 1 are clamped.
vec3 srgb_from_linear(vec3 linear) {
    vec3 light = clamp(linear, 0, 1);
    vec3 curved = 1.055 * pow(max(light, 0.0031308), vec3(1 / 2.4)) - 0.055;
    return min(mix(curved, 12.92 * light, lessThanEqual(light, vec3(0.0031308))), 1);
}
