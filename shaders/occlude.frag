// Darkens the picture by the occlusion, smoothed over the pixels among which its spiral turns, not across edges.
#include "common.glsl"

uniform sampler2D u_depth;
uniform sampler2D u_occlusion;
uniform vec4 u_lens;    // as in occlusion.frag
uniform float u_reach;  // m

float away(vec2 at) { return -u_lens.y / (2.0 * texture(u_depth, at).r - 1.0 + u_lens.x); }

void main() {
  vec2 at = gl_FragCoord.xy / vec2(textureSize(u_depth, 0));
  vec2 e = 1.0 / vec2(textureSize(u_occlusion, 0));
  float here = away(at), sum = 0.0, all = 0.0;
  for (int i = -2; i <= 2; ++i)
    for (int j = -2; j <= 2; ++j) {
      vec2 to = at + e * vec2(i, j);
      float weight = max(1e-3, 1.0 - abs(away(to) - here) / (0.3 * u_reach));
      sum += weight * texture(u_occlusion, to).r;
      all += weight;
    }
  // The light of the sun is not hidden; it is a part of what is there.
  out_color = vec4(vec3(mix(0.15, 1.0, sum / all)), 1.0);
}
