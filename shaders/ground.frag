// The floor with its shadow and faint lines, or, where nothing would land on it, the lines alone. It fades into
// the sky, and from below it is as thin as glass.
#include "common.glsl"

uniform vec4 u_ground;  // centre [m], w: distance at which it has faded
uniform float u_solid;  // 1: things land on it, 0: lines alone

float grid(vec2 p) {
  vec2 width = fwidth(p);
  vec2 d = abs(fract(p - 0.5) - 0.5) / max(width, vec2(1e-5));
  float line = 1.0 - min(min(d.x, d.y), 1.0);
  return line * clamp(1.0 - 2.5 * max(width.x, width.y), 0.0, 1.0);
}

void main() {
  vec3 n = normalize(v_normal);
  float light = lit(v_position, n) * max(dot(n, u_light.xyz), 0.0);
  float step_size = exp2(round(log2(u_eye.w * 0.25)));
  float line = grid(v_uv / step_size);
  vec3 color = vec3(0.40, 0.41, 0.42) * (1.0 - 0.10 * line);
  float far = length(v_position - u_ground.xyz) / u_ground.w;
  finish(color * (ambient(n) * 0.9 + u_light_color.rgb * 0.75 * light));
  if (u_solid < 0.5) out_color = vec4(vec3(0.10, 0.11, 0.13), 0.45 * line);
  float below = u_eye.y < u_ground.y ? 0.25 : 1.0;
  out_color.a *= below * (1.0 - smoothstep(0.15, 1.0, far));
}
