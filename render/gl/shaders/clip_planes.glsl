// Of a vertex: points with a negative dot product with one of CLIPPED planes are not drawn. Eight of them clip, as every driver
// can; fragments beyond the others are discarded (discard_clipped.glsl).
#ifdef CLIPPED
#ifdef INSTANCED
layout(location = 13) in vec4 clip_plane;
#else
layout(location = 20) uniform vec4 clip_planes[CLIPPED];
#endif
#if CLIPPED > 8
out float gl_ClipDistance[8];
out float clip_heights[CLIPPED - 8];
#else
out float gl_ClipDistance[CLIPPED];
#endif
#endif

void clip_by_planes(vec3 local) {
#if defined(CLIPPED) && defined(INSTANCED)
    gl_ClipDistance[0] = dot(clip_plane, vec4(local, 1));
#elif defined(CLIPPED)
    for (int i = 0; i < min(CLIPPED, 8); ++i) gl_ClipDistance[i] = dot(clip_planes[i], vec4(local, 1));
#if CLIPPED > 8
    for (int i = 8; i < CLIPPED; ++i) clip_heights[i - 8] = dot(clip_planes[i], vec4(local, 1));
#endif
#endif
}
