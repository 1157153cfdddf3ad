// The floor, far beyond the scene.
#include "common.glsl"

void main() { surface_vertex(0.0); }
