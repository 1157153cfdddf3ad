// Cloth by its weave: the threads in the normals as far as a pixel shows them, the sheen of their fibres (Estevez
// and Kulla 2017), and the light that comes through.
#include "common.glsl"

uniform float u_weave;   // 0 plain, 1 twill, 2 satin, 3 the grain of leather
uniform vec2 u_threads;  // along the sides of the cloth
uniform float u_sheen;   // strength of the fibres' light

float hash(vec2 p) { return fract(sin(dot(p, vec2(127.1, 311.7))) * 43758.5453); }

// Smooth noise, and so the bumps of leather.
float noise(vec2 p) {
  vec2 i = floor(p), f = fract(p);
  f = f * f * (3.0 - 2.0 * f);
  return mix(mix(hash(i), hash(i + vec2(1.0, 0.0)), f.x),
             mix(hash(i + vec2(0.0, 1.0)), hash(i + vec2(1.0, 1.0)), f.x), f.y);
}

// How far the thread on top turns away across, and whether it runs along v (warp, 1) or u (weft, 0).
vec3 thread_at(vec2 p) {
  vec2 cell = floor(p), at = fract(p) - 0.5;
  float over = u_weave < 0.5   ? mod(cell.x + cell.y, 2.0)
               : u_weave < 1.5 ? step(mod(cell.x + cell.y, 4.0), 2.5)
                               : step(0.5, mod(cell.x + 2.0 * cell.y, 5.0));
  vec2 round_warp = vec2(1.5 * at.x, 0.6 * at.y), round_weft = vec2(0.6 * at.x, 1.5 * at.y);
  return vec3(mix(round_weft, round_warp, over), over);
}

float charlie(float nh, float roughness) {
  float inverse = 1.0 / max(roughness, 0.1);
  return (2.0 + inverse) * pow(max(1.0 - nh * nh, 1e-3), 0.5 * inverse) / (2.0 * kPi);
}

void main() {
  Surface s = seen_surface();
  vec2 p = v_uv * u_threads;
  float width = max(length(dFdx(p)), length(dFdy(p)));
  float seen = u_normal_scale * (1.0 - smoothstep(0.25, 0.7, width));  // threads finer than pixels are flat
  vec3 color = base_color(s);
  vec2 slope;
  if (u_weave > 2.5) {
    float h = noise(0.5 * p), e = 0.35;
    slope = 1.2 * vec2(h - noise(0.5 * (p + vec2(e, 0.0))), h - noise(0.5 * (p + vec2(0.0, e)))) / e;
  } else {
    vec3 thread = thread_at(p);
    slope = thread.xy;
    // The weft of a twill is undyed, as in denim; its back shows more of it.
    float dyed = s.back ? 1.0 - thread.z : thread.z;
    if (u_weave > 0.5 && u_weave < 1.5)
      color = mix(color, vec3(0.55, 0.53, 0.48), 0.4 * mix(s.back ? 0.5 : 0.25, 1.0 - dyed, seen));
  }
  vec3 smooth_normal = s.normal;
  s.normal = normalize(surface_axes(s.normal) * vec3(seen * slope, 1.0));
  vec3 l = u_light.xyz, h = normalize(l + s.view);
  float shadow = lit(s.position, smooth_normal);
  float nl = max(dot(s.normal, l), 0.0), nv = max(dot(s.normal, s.view), 1e-3);
  float fibres = charlie(max(dot(s.normal, h), 0.0), u_roughness) / (4.0 * (nl + nv - nl * nv) + 1e-3);
  vec3 specular = ggx_specular(s.normal, s.view, l, u_roughness, vec3(0.04)) * (u_weave > 1.5 ? 1.0 : 0.4);
  float rim = pow(1.0 - nv, 4.0) * u_sheen;
  finish(color * (ambient(s.normal) * (1.0 + rim) +
                  u_light_color.rgb * shadow * diffuse_share(s.normal, l)) +
         u_light_color.rgb * shadow * (kPi * specular + u_sheen * fibres * nl * mix(vec3(1.0), color, 0.5)));
}
