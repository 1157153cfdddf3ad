// A texture on the cloth, under Blinn-Phong.
#include "common.glsl"

void main() {
  Surface s = seen_surface();
  vec3 color = texture(u_texture, v_uv * u_texture_scale).rgb;
  finish(blinn_phong(s, s.back ? color * 0.7 : color));
}
