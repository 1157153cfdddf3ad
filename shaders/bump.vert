// The surface as it is: bumps are only in its normals.
#include "common.glsl"

void main() { surface_vertex(0.0); }
