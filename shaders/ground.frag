// The floor with its shadow and faint lines.
#include "common.glsl"
#include "floor.glsl"

void main() {
  vec3 n = vec3(0.0, 1.0, 0.0);
  float light = lit(v_position, n) * u_light.y;
  vec3 color = vec3(0.40, 0.41, 0.42) * (1.0 - 0.10 * floor_line());
  finish(color * (ambient(n) * 0.9 + u_light_color.rgb * 0.75 * light));
  out_color.a = floor_alpha();
}
