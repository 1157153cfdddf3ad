// A constraint's end, drawn a little before the surface.
#include "common.glsl"

void main() {
  surface_vertex(0.0);
  gl_Position.z -= 2e-4 * gl_Position.w;
}
