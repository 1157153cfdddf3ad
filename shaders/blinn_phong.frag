// Blinn-Phong reflection; its three parts are switched separately.
#include "common.glsl"

void main() {
  Surface s = seen_surface();
  finish(blinn_phong(s, base_color(s)));
}
