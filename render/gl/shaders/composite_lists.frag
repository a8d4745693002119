#version 450 core
#include "per_pixel_lists.glsl"
// Takes the nearest few of the list, then those behind them, and so on, so that a list of any length needs no more room
// than these.
const int kAtOnce = 16;
out vec4 color;

bool is_nearer(uint a, uint b) {
    float depth_a = fragments[a - 1].depth, depth_b = fragments[b - 1].depth;
    if (depth_a != depth_b) return depth_a > depth_b;
    return fragments[a - 1].order > fragments[b - 1].order;
}

void main() {
    uint first = heads[head_index(ivec2(gl_FragCoord.xy))];
    if (first == 0) discard;
    vec3 sum = vec3(0);
    float transmittance = 1;
    uint done = 0;
    uint nearest[kAtOnce];
    for (int i = 0; i < kAtOnce; ++i) nearest[i] = 0;
    int found;
    do {
        found = 0;
        for (uint at = first; at != 0; at = fragments[at - 1].next) {
            if (done != 0 && !is_nearer(done, at)) continue;
            uint further = at;  // moves the others on, and the last one out
            for (int i = 0; i < found; ++i) {
                uint here = nearest[i];
                bool passes = is_nearer(further, here);
                nearest[i] = passes ? further : here;
                further = passes ? here : further;
            }
            if (found < kAtOnce) nearest[found++] = further;
        }
        for (int i = 0; i < found; ++i) {
            done = nearest[i];
            vec4 own = vec4(unpackUnorm2x16(fragments[done - 1].red_green),
                            unpackUnorm2x16(fragments[done - 1].blue_alpha));
            sum += transmittance * own.rgb;
            transmittance *= 1 - own.a;
        }
    } while (found == kAtOnce && transmittance > 1e-5);
    color = vec4(sum, 1 - transmittance);
}
