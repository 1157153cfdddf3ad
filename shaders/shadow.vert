// Depth as seen from the light.
#include "common.glsl"

uniform mat4 u_light_view_projection;

void main() { gl_Position = u_light_view_projection * vec4(u_place + vec3(a_x, a_y, a_z), 1.0); }
