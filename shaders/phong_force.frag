// The direction of each particle's force as a colour, under Blinn-Phong: normalised, thus lighter
// than ggx_force (seed 000).
#include "common.glsl"

void main() {
  Surface s = seen_surface();
  float size = length(v_force);
  finish(blinn_phong(s, size > 0.0 ? abs(v_force) / size : vec3(0.0)));
}
