// One triangle over the whole view.
#include "common.glsl"

out vec3 v_direction;

void main() {
  vec2 p = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  v_direction = u_forward.xyz + p.x * u_right.xyz + p.y * u_up.xyz;
  gl_Position = vec4(p, 1.0, 1.0);
}
