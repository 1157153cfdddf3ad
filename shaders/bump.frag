// Bumps from the height map, in the normals only; under Blinn-Phong.
#include "common.glsl"

void main() {
  Surface s = seen_surface();
  s.normal = bumped_normal(s);
  finish(blinn_phong(s, base_color(s)));
}
