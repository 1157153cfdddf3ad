// Lambert's law alone.
#include "common.glsl"

void main() {
  Surface s = seen_surface();
  float shadow = lit(s.position, s.normal);
  finish(base_color(s) * (0.12 + 1.6 * shadow * max(dot(s.normal, u_light.xyz), 0.0)));
}
