// The surface as it is.
#include "common.glsl"

void main() { surface_vertex(0.0); }
