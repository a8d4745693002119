// Of a CAP: caps of one plane lie at one depth, whatever part they belong to, so that of several at a pixel the last is seen.
#ifdef CAP
layout(location = 33) uniform vec3 cap_depth;  // its product with (pixel, 1) is the depth
#endif

void write_cap_depth() {
#ifdef CAP
    precise float depth = cap_depth.x * gl_FragCoord.x + cap_depth.y * gl_FragCoord.y + cap_depth.z;
    gl_FragDepth = depth;
#endif
}
