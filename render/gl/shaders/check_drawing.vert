#version 450 core
void main() {
    gl_Position = vec4(gl_VertexID == 1 ? -4 : 0, gl_VertexID == 0 ? -8 : gl_VertexID == 1 ? 0 : 8, 0, 1);
}
