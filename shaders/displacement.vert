// The surface raised by the height map along its normals.
#include "common.glsl"

void main() { surface_vertex((texture(u_height, a_uv * u_texture_scale).r - 0.5) * u_height_scale); }
