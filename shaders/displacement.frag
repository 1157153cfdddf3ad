// The raised surface with the bumps' normals, under Blinn-Phong.
#include "common.glsl"

void main() {
  Surface s = seen_surface();
  if (u_raise != 0.0) {  // of a slope's far side, too, the face is known
    s.back = u_raise < 0.0;
    s.normal = normalize(s.back ? -v_normal : v_normal);
  }
  s.normal = bumped_normal(s);
  finish(blinn_phong(s, base_color(s)));
}
