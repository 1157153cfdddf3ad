// Depth as seen from the light.
#include "common.glsl"

uniform mat4 u_light_view_projection;

void main() {
  surface_vertex(0.0);
  gl_Position = u_light_view_projection * vec4(v_position, 1.0);
}
