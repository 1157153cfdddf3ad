// Constraints as lines in the colour of their kind.
#include "common.glsl"

void main() { out_color = vec4(u_color, 1.0); }
