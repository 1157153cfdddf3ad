// The surface with its strain.
#include "common.glsl"

void main() { surface_vertex(0.0); }
