// Surfaces by metal and roughness (glTF 2.0, appendix B), in view space and linear light. After view_uniforms.glsl,
// phong.glsl and srgb.glsl; COATED ones mirror the surroundings above that.

const float kLeastCosine = 1e-3, kLeastRoughness = 0.05, kCoatRoughness = 0.1, kDielectric = 0.04;

struct MetallicSurface {
    vec3 base;
    float metallic, roughness, clear_coat;
    float occlusion;  // of the surroundings' light
};

float fifth_power(float x) { return x * x * x * x * x; }

// What a white, matte surface with this normal in world space reflects of the surroundings.
vec3 irradiance(vec3 n) {
    return max(harmonics[0].rgb + harmonics[1].rgb * n.y + harmonics[2].rgb * n.z + harmonics[3].rgb * n.x +
                   harmonics[4].rgb * (n.x * n.y) + harmonics[5].rgb * (n.y * n.z) +
                   harmonics[6].rgb * (3 * n.z * n.z - 1) + harmonics[7].rgb * (n.x * n.z) +
                   harmonics[8].rgb * (n.x * n.x - n.y * n.y),
               0);
}

// Pi times the distribution of GGX and the masking of Smith (Heitz 2014). The square of a cross product is what that
// of the cosine is short of 1, and keeps its digits.
float specular_lobe(vec3 n, vec3 h, float n_l, float n_v, float roughness) {
    float squared = roughness * roughness * roughness * roughness, n_h = dot(n, h);
    vec3 off = cross(n, h);
    float spread = dot(off, off) + n_h * n_h * squared;
    float masking = n_l * sqrt(n_v * n_v * (1 - squared) + squared) + n_v * sqrt(n_l * n_l * (1 - squared) + squared);
    return squared / (spread * spread) * 0.5 / masking;
}

// Linear, from 0. `light` is incident_light(); `glossy` is what the surroundings send in the lobe around the reflected
// ray, `sharp` along the ray that the `smooth_normal` reflects.
vec3 metallic_roughness(MetallicSurface surface, vec4 light, vec3 n, vec3 smooth_normal, vec3 to_eye, vec3 glossy,
                        vec3 sharp) {
    float roughness = max(surface.roughness, kLeastRoughness);
    vec3 matte = surface.base * (1 - surface.metallic);
    vec3 facing = mix(vec3(kDielectric), surface.base, surface.metallic);
    float n_v = max(dot(n, to_eye), kLeastCosine);

    vec4 fit = roughness * vec4(-1, -0.0275, -0.572, 0.022) + vec4(1, 0.0425, 1.04, -0.04);  // Karis 2014
    float bend = min(fit.x * fit.x, exp2(-9.28 * n_v)) * fit.x + fit.y;
    vec2 once = vec2(-1.04 * bend + fit.z, 1.04 * bend + fit.w);
    vec3 reflectance = facing * once.x + once.y;
    // What is reflected more than once (Fdez-Agüera 2019).
    float left = 1 - (once.x + once.y);
    vec3 mean = facing + (1 - facing) / 21, scattered = reflectance * mean * left / (1 - left * mean);
    vec3 color = surface.occlusion * ((scattered + matte * (1 - reflectance - scattered)) *
                                          irradiance(world_from_view * n) +
                                      reflectance * glossy);

    vec3 power = light_color.rgb * (light.w * light_color.a);
    vec3 h = light.xyz + to_eye;
    h /= max(length(h), 1e-30);
    float grazing = fifth_power(1 - max(dot(to_eye, h), 0));
    float n_l = dot(n, light.xyz);
    if (n_l > 0) {
        vec3 fresnel = facing + (1 - facing) * grazing;
        color += (matte * (1 - fresnel) + fresnel * specular_lobe(n, h, n_l, n_v, roughness)) * power * n_l;
    }

#ifdef COATED
    {
        n_v = max(dot(smooth_normal, to_eye), kLeastCosine);
        float through = surface.clear_coat * (kDielectric + (1 - kDielectric) * fifth_power(1 - n_v));
        color = mix(color, sharp, through);
        n_l = dot(smooth_normal, light.xyz);
        if (n_l > 0)
            color += power * (n_l * surface.clear_coat * (kDielectric + (1 - kDielectric) * grazing) *
                              specular_lobe(smooth_normal, h, n_l, n_v, kCoatRoughness));
    }
#endif
    return color;
}
