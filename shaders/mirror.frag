// A perfect mirror of the sky.
#include "common.glsl"

void main() {
  Surface s = seen_surface();
  finish(textureLod(u_sky, reflect(-s.view, s.normal), 0.0).rgb);
}
