// What the floor and the grid share: their lines, and how they fade into the sky.
uniform vec4 u_ground;  // centre [m], w: distance at which it has faded

float grid(vec2 p) {
  vec2 width = fwidth(p);
  vec2 d = abs(fract(p - 0.5) - 0.5) / max(width, vec2(1e-5));
  float line = 1.0 - min(min(d.x, d.y), 1.0);
  return line * clamp(1.0 - 2.5 * max(width.x, width.y), 0.0, 1.0);
}

// 1: there is a line.
float floor_line() { return grid(v_uv / exp2(round(log2(u_eye.w * 0.25)))); }

// From below it is as thin as glass.
float floor_alpha() {
  float far = length(v_position - u_ground.xyz) / u_ground.w;
  return (u_eye.y < u_ground.y ? 0.25 : 1.0) * (1.0 - smoothstep(0.15, 1.0, far));
}
