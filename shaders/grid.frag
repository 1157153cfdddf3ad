// Lines alone, where nothing would land on a floor.
#include "common.glsl"
#include "floor.glsl"

void main() { out_color = vec4(vec3(0.10, 0.11, 0.13), 0.45 * floor_line() * floor_alpha()); }
