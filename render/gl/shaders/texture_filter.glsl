// Textures of upload_texture() and upload_cube_map(), for fragment shaders. Bilinear where a pixel is smaller than a
// texel, else trilinear at the level log2 of the pixel's longer side in texels. Drivers approximate that level, and the
// mixing of two; so both are computed here. At level 0 the texture's own magnification counts.

// Of a pixel whose sides, in texels, are these.
float mip_level(vec3 across, vec3 up) { return 0.5 * log2(max(max(dot(across, across), dot(up, up)), 1)); }
float mip_level(vec2 across, vec2 up) { return mip_level(vec3(across, 0), vec3(up, 0)); }

vec4 sample_level(sampler2D image, vec2 uv, float level) {
    float finer = floor(level);
    return mix(textureLod(image, uv, finer), textureLod(image, uv, finer + 1), level - finer);
}

#ifdef ANISOTROPIC
// The mean along the pixel's longer side, at the level of its shorter one, or of a 16th of the longer
// (EXT_texture_filter_anisotropic).
vec4 sample_filtered(sampler2D image, vec2 uv) {
    vec2 size = vec2(textureSize(image, 0)), dx = dFdx(uv), dy = dFdy(uv);
    float across = length(dx * size), up = length(dy * size);
    float longer = max(across, up), shorter = max(min(across, up), 1);
    int count = int(clamp(ceil(longer / shorter), 1, 16));
    float level = log2(max(longer / count, 1));
    vec2 along = across > up ? dx : dy;
    vec4 sum = vec4(0);
    for (int i = 0; i < count; ++i) sum += sample_level(image, uv + ((i + 0.5) / count - 0.5) * along, level);
    return sum / count;
}
#else
vec4 sample_filtered(sampler2D image, vec2 uv) {
    vec2 size = vec2(textureSize(image, 0));
    return sample_level(image, uv, mip_level(dFdx(uv) * size, dFdy(uv) * size));
}
#endif

// What lies in a direction of the world, of any length, which changes by `across` and `up` over a pixel.
vec3 sample_environment(samplerCube environment_map, vec3 direction, vec3 across, vec3 up) {
    // On the cube whose faces lie at 1, where that direction meets it, and in texels.
    vec3 size = abs(direction);
    vec3 axis = size.y >= size.z ? vec3(0, 1, 0) : vec3(0, 0, 1);
    if (size.x >= size.y && size.x >= size.z) axis = vec3(1, 0, 0);
    float ahead = dot(axis, direction);
    float texels = float(textureSize(environment_map, 0).x) / (2 * ahead * ahead);
    float level = mip_level((across * ahead - direction * dot(axis, across)) * texels,
                           (up * ahead - direction * dot(axis, up)) * texels);
    float finer = floor(level);
    direction.z = -direction.z;
    vec3 at_finer = textureLod(environment_map, direction, finer).rgb;
    return mix(at_finer, textureLod(environment_map, direction, finer + 1).rgb, level - finer);
}

// The linear light that rough surfaces reflect of the environment around a direction of the world, of
// scene::EnvironmentLight.
vec3 sample_prefiltered(samplerCube prefiltered_map, vec3 direction, float roughness) {
    float level = roughness * float(textureQueryLevels(prefiltered_map) - 1), finer = floor(level);
    direction.z = -direction.z;
    vec3 at_finer = textureLod(prefiltered_map, direction, finer).rgb;
    vec3 root = mix(at_finer, textureLod(prefiltered_map, direction, finer + 1).rgb, level - finer);
    return root * root;
}
