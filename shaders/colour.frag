// The cloth's own colour under GGX reflection.
#include "common.glsl"

void main() {
  Surface s = seen_surface();
  finish(ggx(s, base_color(s)));
}
