// How much of the sky what lies around hides from each point (McGuire et al., Alchemy, 2011): from the depths of
// the picture, over points of a spiral whose turn changes from pixel to pixel.
#include "common.glsl"

uniform sampler2D u_depth;
uniform vec4 u_lens;    // depth = z/w by (x, y): z -> -y / (depth + x); half the view's width and height at 1 m
uniform float u_reach;  // m

vec3 place(vec2 at) {
  float z = u_lens.y / (2.0 * texture(u_depth, at).r - 1.0 + u_lens.x);
  return vec3((2.0 * at - 1.0) * u_lens.zw * z, -z);
}

void main() {
  const int kSamples = 14;
  vec2 pixels = vec2(textureSize(u_depth, 0));
  vec2 at = (2.0 * floor(gl_FragCoord.xy) + 0.5) / pixels;  // the middle of a pixel of the depths
  vec3 p = place(at);
  vec2 e = 1.0 / pixels;
  // The nearer neighbour on each axis lies on the same surface.
  vec3 left = p - place(at - vec2(e.x, 0.0)), right = place(at + vec2(e.x, 0.0)) - p;
  vec3 below = p - place(at - vec2(0.0, e.y)), above = place(at + vec2(0.0, e.y)) - p;
  vec3 n = normalize(cross(abs(left.z) < abs(right.z) ? left : right,
                           abs(below.z) < abs(above.z) ? below : above));
  vec2 reach = u_reach / (2.0 * u_lens.zw * -p.z);
  float turn = 6.2832 * fract(52.9829 * fract(dot(gl_FragCoord.xy, vec2(0.06711, 0.00584))));
  float sum = 0.0;
  for (int k = 0; k < kSamples; ++k) {
    float angle = turn + 2.39996 * float(k);
    vec2 to = at + reach * sqrt((float(k) + 0.5) / float(kSamples)) * vec2(cos(angle), sin(angle));
    vec3 v = place(to) - p;
    float square = dot(v, v);
    float near = clamp(1.0 - square / (u_reach * u_reach), 0.0, 1.0);
    sum += near * max(0.0, dot(v, n) * inversesqrt(square + 1e-8) - 0.12);
  }
  out_color = vec4(clamp(1.0 - 2.6 * sum / float(kSamples), 0.0, 1.0));
}
