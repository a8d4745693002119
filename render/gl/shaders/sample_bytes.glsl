layout(location = 0) uniform int source_max;  // 255 or 65535: one sample of that depth; 0: the sum over samples
layout(location = 1) uniform int samples;
layout(binding = 0) uniform sampler2D source;

uvec4 bytes_at(ivec2 at) {
    vec4 texel = texelFetch(source, at, 0);
    if (source_max == 255) return uvec4(round(texel * 255));
    if (source_max == 65535) return (uvec4(round(texel * 65535)) * 255 + 32895) >> 16;  // as Framebuffer::read
    return (uvec4(texel) + uint(samples / 2)) / uint(samples);
}
