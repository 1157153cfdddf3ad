// The surface with its texture coordinates.
#include "common.glsl"

void main() { surface_vertex(0.0); }
