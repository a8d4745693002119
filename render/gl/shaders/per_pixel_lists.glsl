// Lists of the transparent layers at each pixel of a box. Layers are numbered from 1.
struct Fragment {
    uint next;  // in the same pixel; 0 for none
    uint order;  // of triangles; at equal depth the higher one is in front
    float depth;  // reversed
    uint red_green, blue_alpha;  // multiplied by alpha
};
layout(std430, binding = 0) buffer Fragments {
    uint count, most, unused_0, unused_1;
    Fragment fragments[];
};
layout(std430, binding = 1) buffer Lists {
    ivec4 box;  // low corner and size
    uint heads[];
};
int head_index(ivec2 pixel) { return (pixel.y - box.y) * box.z + pixel.x - box.x; }
