// The position of the sample runs from -1 to 1 over the view, and so does `shift`.
layout(location = 0) uniform vec2 pixel;
layout(location = 1) uniform vec2 shift;
out vec4 color;

vec2 sample_position() { return gl_FragCoord.xy * pixel - 1 + shift; }
