// The force of the springs on each particle as a colour, x y z as red green blue, under GGX (seed 000).
#include "common.glsl"

void main() {
  Surface s = seen_surface();
  finish(ggx(s, abs(v_force) * u_force_scale + 0.02));
}
