// Greatest strain of the structural constraints at each particle, blue (none) to red.
#include "common.glsl"

void main() {
  Surface s = seen_surface();
  vec3 color = heat(v_strain / u_strain_range);
  float shade = 0.75 + 0.35 * dot(s.normal, u_light.xyz);
  out_color = vec4(color * shade, 1.0);
}
