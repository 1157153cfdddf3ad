// The sky behind the scene, a soft gradient so that it does not compete with the cloth.
#include "common.glsl"

in vec3 v_direction;

void main() {
  float y = normalize(v_direction).y;
  vec3 horizon = vec3(0.62, 0.67, 0.72), zenith = vec3(0.20, 0.32, 0.50);
  vec3 below = vec3(0.40, 0.41, 0.42);
  vec3 c = y > 0.0 ? mix(horizon, zenith, pow(y, 0.6)) : mix(horizon, below, pow(-y, 0.5));
  out_color = vec4(c, 1.0);
}
