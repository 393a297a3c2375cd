#version 330
uniform mat4 clip_from_object;
in vec4 vertex;
void main() { gl_Position = clip_from_object * vertex; }
