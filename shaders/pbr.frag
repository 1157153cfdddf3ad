// Metallic-roughness material under the light and the image of the sky (seed 003): base colour, metallic,
// roughness and normal from maps, or plain values; irradiance from the sky's smallest levels, reflections
// from the level of the roughness; the environment's share of the reflection by Karis' fit (2014).
#include "common.glsl"

struct Material {
  vec3 color;
  float metallic;
  float roughness;
};

vec2 environment_share(float roughness, float nv) {
  vec4 r = roughness * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
  float a = min(r.x * r.x, exp2(-9.28 * nv)) * r.x + r.y;
  return vec2(-1.04, 1.04) * a + r.zw;
}

Material material_of(Surface s) {
  if (u_maps < 0.5) return Material(base_color(s), u_metallic, u_roughness);
  vec2 uv = v_uv * u_texture_scale;
  return Material(texture(u_base_color_map, uv).rgb, texture(u_metallic_map, uv).r,
                  texture(u_roughness_map, uv).r);
}

vec3 mapped_normal(Surface s) {
  if (u_maps < 0.5) return s.normal;
  vec3 n = 2.0 * texture(u_normal_map, v_uv * u_texture_scale).xyz - 1.0;
  return normalize(surface_axes(s.normal) * vec3(u_normal_scale * n.xy, max(n.z, 1e-3)));
}

void main() {
  Surface s = seen_surface();
  float shadow = lit(s.position, s.normal);
  Material m = material_of(s);
  s.normal = mapped_normal(s);
  vec3 f0 = mix(vec3(0.04), m.color, m.metallic);
  float levels = log2(float(textureSize(u_sky, 0).x));
  vec3 irradiance = textureLod(u_sky, s.normal, levels - 1.0).rgb;
  vec3 reflected = textureLod(u_sky, reflect(-s.view, s.normal),
                              m.roughness * (levels - 2.0)).rgb;
  vec2 share = environment_share(m.roughness, max(dot(s.normal, s.view), 0.0));
  vec3 diffuse = m.color * (1.0 - m.metallic) *
                 (irradiance + u_light_color.rgb * shadow * diffuse_share(s.normal, u_light.xyz));
  vec3 specular = reflected * (f0 * share.x + share.y) +
                  kPi * u_light_color.rgb * shadow *
                      ggx_specular(s.normal, s.view, u_light.xyz, m.roughness, f0);
  finish(diffuse + specular);
}
