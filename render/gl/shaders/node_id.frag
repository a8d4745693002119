#version 450 core
layout(location = 4) uniform int number;
out int node;

void main() { node = number; }
