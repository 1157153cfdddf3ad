// The surface with its forces.
#include "common.glsl"

void main() { surface_vertex(0.0); }
