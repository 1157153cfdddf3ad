// Shared by all looks: the frame's uniforms, the vertex stage's inputs and outputs, lights, shadow,
// noise-free tone mapping. Included by every shader; the program defines WEFT_VERTEX or
// WEFT_FRAGMENT before. Positions in metres, y up; colours linear until finish().

layout(std140) uniform Frame {
  mat4 u_view_projection;
  mat4 u_shadow_matrix;  // world -> shadow map, 0 … 1
  vec4 u_eye;            // w: size of the scene [m]
  vec4 u_light;          // direction towards the light; w: shadow bias [m]
  vec4 u_light_color;    // w: samples along a side of the shadow's soft edge; 0: no shadows
  vec4 u_right;          // camera axes scaled to the edge of the view, for the background
  vec4 u_up;
  vec4 u_forward;
};

// The material of what is drawn now.
uniform vec3 u_color;       // facing the normal
uniform vec3 u_back_color;  // the other side
uniform float u_roughness;
uniform float u_metallic;
uniform float u_translucency;  // share of light that shines through (cloth)
uniform float u_two_sided;     // 1: cloth, whose back is seen as well, 0: a closed body
uniform vec3 u_parts;          // ambient, diffuse, specular: 1 on, 0 off
uniform float u_shininess;
uniform float u_normal_scale;
uniform vec3 u_place;           // m, where the surface's origin stands
uniform float u_raise;          // m, along the normal, of what is highest
uniform float u_half_thickness;  // m, of the cloth, along the normal of the face that is drawn
uniform vec2 u_texture_scale;   // repeats over the surface
uniform float u_force_scale;    // 1/N: maps forces to colours
uniform float u_strain_range;   // strain at the end of the colour scale

uniform samplerCube u_sky;
uniform sampler2DShadow u_shadow;
uniform sampler2D u_texture;
uniform sampler2D u_height;

// The maps of the look pbr; u_maps: 1 they count, 0 the plain values above do.
uniform float u_maps;
uniform sampler2D u_base_color_map;
uniform sampler2D u_metallic_map;
uniform sampler2D u_roughness_map;
uniform sampler2D u_normal_map;

const float kPi = 3.14159265;

#ifdef WEFT_VERTEX
// Components as separate arrays, as the simulation stores them.
layout(location = 0) in float a_x;
layout(location = 1) in float a_y;
layout(location = 2) in float a_z;
layout(location = 3) in float a_nx;
layout(location = 4) in float a_ny;
layout(location = 5) in float a_nz;
layout(location = 6) in vec2 a_uv;
layout(location = 7) in float a_fx;  // force of the springs [N]
layout(location = 8) in float a_fy;
layout(location = 9) in float a_fz;
layout(location = 10) in float a_strain;

out vec3 v_position;
out vec3 v_normal;
out vec2 v_uv;
out vec3 v_force;
out float v_strain;

// Hands the face on, lifted along the surface's normal by `height` [m] above where the cloth's thickness has it.
void surface_vertex(float height) {
  v_normal = normalize(vec3(a_nx, a_ny, a_nz));
  v_position = u_place + vec3(a_x, a_y, a_z) + (height + u_half_thickness) * v_normal;
  v_uv = a_uv;
  v_force = vec3(a_fx, a_fy, a_fz);
  v_strain = a_strain;
  gl_Position = u_view_projection * vec4(v_position, 1.0);
}
#endif

#ifdef WEFT_FRAGMENT
in vec3 v_position;
in vec3 v_normal;
in vec2 v_uv;
in vec3 v_force;
in float v_strain;

layout(location = 0) out vec4 out_color;

struct Surface {
  vec3 position;
  vec3 normal;  // towards the eye
  vec3 view;    // towards the eye
  bool back;    // the side away from the cloth's own normal is seen
};

Surface seen_surface() {
  Surface s;
  s.position = v_position;
  s.view = normalize(u_eye.xyz - v_position);
  s.normal = normalize(v_normal);
  // The triangle tells the side: normals between vertices turn away before the surface does.
  s.back = u_two_sided > 0.5 && !gl_FrontFacing;
  if (s.back) s.normal = -s.normal;
  s.normal = normalize(s.normal + s.view * max(0.0, 0.02 - dot(s.normal, s.view)));
  return s;
}

vec3 base_color(Surface s) { return s.back ? u_back_color : u_color; }

// Share of the light that reaches the point: n x n comparisons, each filtered by the sampler.
float lit(vec3 position, vec3 normal) {
  if (u_light_color.w < 0.5) return 1.0;
  float side = dot(normal, u_light.xyz) < 0.0 ? -1.0 : 1.0;
  float through = side < 0.0 ? abs(u_half_thickness) : 0.0;  // to the middle of the cloth, which the map has
  vec3 p = position + side * normal * (u_light.w + through) + u_light.xyz * u_light.w;
  vec3 at = (u_shadow_matrix * vec4(p, 1.0)).xyz;
  if (any(lessThan(at, vec3(0.0))) || any(greaterThan(at, vec3(1.0)))) return 1.0;
  int n = int(u_light_color.w);
  vec2 texel = (n > 2 ? 1.8 : 1.3) / vec2(textureSize(u_shadow, 0));
  float sum = 0.0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      sum += texture(u_shadow, vec3(at.xy + (vec2(i, j) - 0.5 * float(n - 1)) * texel, at.z));
  return sum / float(n * n);
}

// Light from the sky and, from below, from the ground.
vec3 ambient(vec3 normal) {
  vec3 sky = vec3(0.50, 0.58, 0.70), ground = vec3(0.24, 0.22, 0.20);
  return mix(ground, sky, normal.y * 0.5 + 0.5);
}

// GGX microfacets (Walter et al. 2007) with Smith's shadowing (height-correlated, Heitz 2014) and
// Schlick's Fresnel term.
vec3 ggx_specular(vec3 n, vec3 v, vec3 l, float roughness, vec3 f0) {
  vec3 h = normalize(l + v);
  float nl = max(dot(n, l), 0.0), nv = max(dot(n, v), 1e-3), nh = max(dot(n, h), 0.0);
  float a2 = pow(max(roughness, 0.04), 4.0);
  float d = a2 / (kPi * pow(nh * nh * (a2 - 1.0) + 1.0, 2.0));
  float g = 0.5 / max(nl * sqrt(nv * nv * (1.0 - a2) + a2) + nv * sqrt(nl * nl * (1.0 - a2) + a2),
                      1e-4);
  vec3 f = f0 + (1.0 - f0) * pow(1.0 - max(dot(h, v), 0.0), 5.0);
  return d * g * f * nl;
}

// Lambert's law, and the light that comes through the cloth from its other side.
float diffuse_share(vec3 n, vec3 l) {
  float nl = dot(n, l);
  return max(nl, 0.0) + u_translucency * max(-nl, 0.0);
}

vec3 ggx(Surface s, vec3 color) {
  vec3 l = u_light.xyz;
  float shadow = lit(s.position, s.normal);
  vec3 specular = ggx_specular(s.normal, s.view, l, u_roughness, vec3(0.04));
  float rim = pow(1.0 - max(dot(s.normal, s.view), 0.0), 4.0) * u_translucency;  // fuzz of fibres
  return color * (ambient(s.normal) * (1.0 + rim) +
                  u_light_color.rgb * shadow * diffuse_share(s.normal, l)) +
         kPi * u_light_color.rgb * shadow * specular;
}

vec3 blinn_phong(Surface s, vec3 color) {
  vec3 l = u_light.xyz;
  float shadow = lit(s.position, s.normal);
  vec3 h = normalize(l + s.view);
  float nl = max(dot(s.normal, l), 0.0);
  float specular = nl > 0.0 ? pow(max(dot(s.normal, h), 0.0), u_shininess) : 0.0;
  return u_parts.x * color * ambient(s.normal) +
         u_parts.y * color * u_light_color.rgb * shadow * diffuse_share(s.normal, l) +
         u_parts.z * 0.35 * u_light_color.rgb * shadow * specular;
}

// Axes along increasing u and v on the surface, from screen-space derivatives.
mat3 surface_axes(vec3 n) {
  vec3 px = dFdx(v_position), py = dFdy(v_position);
  vec2 ux = dFdx(v_uv), uy = dFdy(v_uv);
  vec3 t = px * uy.y - py * ux.y;
  t -= n * dot(n, t);
  float along = length(t);
  t = along > 0.0 ? t / along : normalize(cross(n, vec3(0.3, 0.8, 0.5)));
  float turn = ux.x * uy.y - ux.y * uy.x < 0.0 ? -1.0 : 1.0;
  t *= turn;
  vec3 b = cross(n, t);
  vec3 bv = (py * ux.x - px * uy.x) * turn;
  return mat3(t, dot(b, bv) < 0.0 ? -b : b, n);
}

// Normal of the face seen, raised by the height map: the slope along u and v by differences of one
// texel, turned into the surface's axes.
vec3 bumped_normal(Surface s) {
  vec2 uv = v_uv * u_texture_scale;
  vec2 texel = 1.0 / vec2(textureSize(u_height, 0));
  float h = texture(u_height, uv).r;
  float du = texture(u_height, uv + vec2(texel.x, 0.0)).r - h;
  float dv = texture(u_height, uv + vec2(0.0, texel.y)).r - h;
  vec3 slope = vec3(-u_normal_scale * vec2(du, dv) * 10.0, 1.0);
  return normalize(surface_axes(s.normal) * slope);
}

// Filmic curve (Hable's form, white at 6), then sRGB by the framebuffer.
vec3 filmic(vec3 x) {
  return ((x * (0.22 * x + 0.03) + 0.002) / (x * (0.22 * x + 0.3) + 0.06)) - 0.02 / 0.6;
}
void finish(vec3 color) { out_color = vec4(filmic(color * 1.35) / filmic(vec3(6.0)), 1.0); }

// Blue, green, yellow, red for 0 … 1.
vec3 heat(float t) {
  t = clamp(t, 0.0, 1.0);
  vec3 a = vec3(0.02, 0.06, 0.42), b = vec3(0.02, 0.45, 0.55), c = vec3(0.30, 0.75, 0.10),
       d = vec3(0.95, 0.65, 0.02), e = vec3(0.75, 0.03, 0.02);
  if (t < 0.25) return mix(a, b, t * 4.0);
  if (t < 0.5) return mix(b, c, t * 4.0 - 1.0);
  if (t < 0.75) return mix(c, d, t * 4.0 - 2.0);
  return mix(d, e, t * 4.0 - 3.0);
}
#endif
