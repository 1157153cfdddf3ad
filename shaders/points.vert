// Particles as round points of the same size in the world.
#include "common.glsl"

uniform float u_point_size;  // m
uniform float u_pixels;      // height of the view, over the tangent of half its angle

void main() {
  surface_vertex(0.0);
  gl_PointSize = clamp(u_point_size * u_pixels / gl_Position.w, 2.0, 40.0);
}
