// Of a fragment: beyond the planes that clip_planes.glsl has not clipped by.
#if defined(CLIPPED) && CLIPPED > 8
in float clip_heights[CLIPPED - 8];
#else
#undef CLIPPED
#endif

void discard_clipped() {
#ifdef CLIPPED
    for (int i = 0; i < CLIPPED - 8; ++i)
        if (clip_heights[i] < 0) discard;
#endif
}
