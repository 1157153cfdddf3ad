// A face of the cloth, raised by the height map. Both faces rise from the sheet, each to its own side,
// so that nothing beneath either comes through; at the hem they meet.
#include "common.glsl"

const float kHem = 0.02;  // of the cloth's width

void main() {
  vec2 border = min(a_uv, 1.0 - a_uv);
  float hem = clamp(min(border.x, border.y) / kHem, 0.0, 1.0);
  surface_vertex(hem * u_raise * texture(u_height, a_uv * u_texture_scale).r);
}
