// Normals as colours: x y z of -1 … 1 as red green blue of 0 … 1.
#include "common.glsl"

void main() {
  vec3 c = seen_surface().normal * 0.5 + 0.5;
  out_color = vec4(pow(c, vec3(2.2)), 1.0);  // the framebuffer turns it back
}
