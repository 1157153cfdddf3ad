// Metallic-roughness material under the light and the image of the sky (seed 003): irradiance from its
// smallest levels, reflections from the level of the roughness; the environment's share of the
// reflection by Karis' fit (2014).
#include "common.glsl"

vec2 environment_share(float roughness, float nv) {
  vec4 r = roughness * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
  float a = min(r.x * r.x, exp2(-9.28 * nv)) * r.x + r.y;
  return vec2(-1.04, 1.04) * a + r.zw;
}

void main() {
  Surface s = seen_surface();
  vec3 color = base_color(s);
  vec3 f0 = mix(vec3(0.04), color, u_metallic);
  float shadow = lit(s.position, s.normal);
  float levels = log2(float(textureSize(u_sky, 0).x));
  vec3 irradiance = textureLod(u_sky, s.normal, levels - 1.0).rgb;
  vec3 reflected = textureLod(u_sky, reflect(-s.view, s.normal),
                              u_roughness * (levels - 2.0)).rgb;
  vec2 share = environment_share(u_roughness, max(dot(s.normal, s.view), 0.0));
  vec3 diffuse = color * (1.0 - u_metallic) *
                 (irradiance + u_light_color.rgb * shadow * diffuse_share(s.normal, u_light.xyz));
  vec3 specular = reflected * (f0 * share.x + share.y) +
                  kPi * u_light_color.rgb * shadow *
                      ggx_specular(s.normal, s.view, u_light.xyz, u_roughness, f0);
  finish(diffuse + specular);
}
