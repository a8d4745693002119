// A vertex relative to the origin of view_from_local. A DOUBLE_SINGLE position is the sum of two floats; that origin lies
// near the eye, so that the difference is exact near it.
layout(location = 0) in vec3 position;
#ifdef DOUBLE_SINGLE
layout(location = 3) in vec3 low_position;
layout(location = 14) uniform vec3 origin;

vec3 local_position() {
    precise vec3 local = (position - origin) + low_position;
    return local;
}
#else
vec3 local_position() { return position; }
#endif
