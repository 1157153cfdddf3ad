// Each particle as a lit ball.
#include "common.glsl"

void main() {
  vec2 p = gl_PointCoord * 2.0 - 1.0;
  float r2 = dot(p, p);
  if (r2 > 1.0) discard;
  vec3 n = normalize(p.x * normalize(u_right.xyz) - p.y * normalize(u_up.xyz) -
                     sqrt(1.0 - r2) * normalize(u_forward.xyz));
  finish(u_color * (ambient(n) + u_light_color.rgb * max(dot(n, u_light.xyz), 0.0)));
}
