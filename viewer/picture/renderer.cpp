// The passes of a picture, in order: draw() reads like the list.
#include "picture/renderer.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "picture/cpu_time.h"
#include "weft/mesh.h"

namespace weft::viewer {

namespace {

const Vec3f kLight = normalized({-0.42f, 0.80f, 0.50f});
constexpr Vec3f kLightColor{1.05f, 0.98f, 0.88f};

// As common.glsl's block Frame.
struct FrameBlock {
  Mat4 view_projection, shadow_matrix;
  float eye[4], light[4], light_color[4], right[4], up[4], forward[4];
};

// Between particles that rest on a round body the cloth runs straight, s²/8r below its surface, and
// deeper where it is stretched: the body is drawn smaller by s²/2r, where its offset does not make up
// for it.
void shrink(Collider& body, double s) {
  const auto less = [&](double r) {
    return std::max(0.95 * r, r - std::max(0.0, s * s / (2 * r) - body.offset));
  };
  for_each_value(body.shape, [&](const char*, auto& value, ShapeValue is) {
    if constexpr (std::is_same_v<decltype(value), double&>)
      if (is == ShapeValue::radius) value = less(value);
  });
}

// Of a sheet along u and v; of a mesh, whose texture coordinates are its file's or span its two longest sides,
// about what they are for.
std::pair<float, float> sides_of(const Cloth& cloth) {
  if (!cloth.mesh.given()) return {length(to_float(cloth.grid.u)), length(to_float(cloth.grid.v))};
  Bounds bounds;
  for (const Vec3& p : cloth.mesh.shape->vertices) bounds.add(to_float(p));
  const auto scale = static_cast<float>(cloth.mesh.scale);
  const Vec3f size = (bounds.high - bounds.low) * scale;
  float sides[3] = {size.x, size.y, size.z};
  std::sort(std::begin(sides), std::end(sides));
  return {sides[2], sides[1]};
}

void set(float (&to)[4], Vec3f v, float w) {
  to[0] = v.x, to[1] = v.y, to[2] = v.z, to[3] = w;
}

}  // namespace

Renderer::Renderer(const PictureFiles& files)
    : folder_(find_shaders()), frame_(make_buffer()), nothing_(make_vertex_array()) {
  set_pictures(files);
  glEnable(GL_DEPTH_TEST);
  glEnable(GL_PROGRAM_POINT_SIZE);
  glEnable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
}

void Renderer::set_pictures(const PictureFiles& files) {
  std::size_t count = 0;
  const auto put = [&](Texture& shown, const std::string& path, const std::string& before,
                       auto&& load) {
    std::string& problem = picture_problems_[count++];
    if (shown && path == before) return;
    problem.clear();
    Texture read = load(path, problem);
    if (std::string none; !read && !shown) read = load("", none);
    if (read) shown = std::move(read);
  };
  put(texture_, files.texture, files_.texture, load_texture);
  put(height_map_, files.height_map, files_.height_map, load_height_map);
  put(sky_, files.sky, files_.sky, [](const std::string& path, std::string& problem) {
    return load_sky(path, kLight, problem);
  });
  for (std::size_t map = 0; map < material_.size(); ++map)
    put(material_[map], files.material[map], files_.material[map],
        [&](const std::string& path, std::string& problem) {
          return load_material_map(static_cast<MaterialMap>(map), path, problem);
        });
  files_ = files;
}

const Shader& Renderer::shader(std::string_view name) {
  auto found = shaders_.find(name);
  if (found == shaders_.end())
    found = shaders_.emplace(std::string(name), Shader(folder_, std::string(name))).first;
  return found->second;
}

bool Renderer::reload_changed() {
  bool changed = false;
  for (auto& [name, shader] : shaders_) changed = shader.reload_if_changed() || changed;
  return changed;
}

std::vector<std::string> Renderer::problems() const {
  std::vector<std::string> all;
  std::copy_if(picture_problems_.begin(), picture_problems_.end(), std::back_inserter(all),
               [](const std::string& problem) { return !problem.empty(); });
  for (const auto& [name, shader] : shaders_)
    if (!shader.error().empty()) all.push_back(shader.error());
  return all;
}

void Renderer::draw(const FrameData& frame_data, const Setting& setting, const Look& look,
                    const LookSettings& settings, const Camera& camera,
                    const RenderTarget& target) {
  const float aspect = static_cast<float>(target.width()) / static_cast<float>(target.height());
  update_meshes(frame_data, setting, look, settings);
  update_bodies(frame_data, setting, settings);
  draw_shadow_map(frame_data, setting, look, settings);
  upload_frame(setting, settings, camera, aspect);
  const std::pair<GLenum, GLuint> textures[] = {
      {GL_TEXTURE_CUBE_MAP, sky_.id()},   {GL_TEXTURE_2D, shadow_map_->texture()},
      {GL_TEXTURE_2D, texture_.id()},     {GL_TEXTURE_2D, height_map_.id()},
      {GL_TEXTURE_2D, material_[0].id()}, {GL_TEXTURE_2D, material_[1].id()},
      {GL_TEXTURE_2D, material_[2].id()}, {GL_TEXTURE_2D, material_[3].id()}};
  for (GLuint unit = 0; unit < std::size(textures); ++unit) {
    glActiveTexture(GL_TEXTURE0 + unit);
    glBindTexture(textures[unit].first, textures[unit].second);
  }
  glActiveTexture(GL_TEXTURE0);

  target.begin();
  glDisable(GL_DEPTH_TEST);
  shader("background").use();
  glBindVertexArray(nothing_.id());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glEnable(GL_DEPTH_TEST);
  draw_bodies(look, settings, camera);
  draw_cloths(frame_data, look, settings, target, setting);
  if (settings.ground && setting.has_ground) draw_ground(setting);  // it may be seen through
  target.resolve();
  constexpr float kReach = 0.1f;  // sizes of the scene
  if (settings.fine)
    occlusion_.apply(target, shader("occlusion"), shader("occlude"), camera, kReach * setting.size);
}

void Renderer::update_meshes(const FrameData& frame_data, const Setting& setting, const Look& look,
                             const LookSettings& settings) {
  const bool shown = shown_scene_ == frame_data.scene_serial && shown_frame_ == frame_data.frame &&
                     shown_change_ == frame_data.change && shown_look_ == &look &&
                     shown_refinement_ == settings.refinement && shown_detail_ == settings.detail &&
                     shown_fine_ == settings.fine;
  if (shown) return;
  const double start = cpu_ms();
  cloths_.resize(frame_data.cloths.size());
  thicknesses_.resize(cloths_.size());
  for (std::size_t c = 0; c < cloths_.size(); ++c) {
    const ClothCopy& cloth = frame_data.cloths[c];
    const Sampling sampling = settings.refinement > 0 ? Sampling{settings.refinement, 1}
                                                      : sampling_of(cloth, settings.detail);
    const Cloth& description = frame_data.scene->cloths[c];
    const bool thick = settings.fine && look.draw == Look::Draw::surface;
    thicknesses_[c] = thick ? thickness_of(description) : 0;
    cloths_[c].update(cloth, frame_data.scene_serial, description, look, sampling, thicknesses_[c]);
  }
  const Cloth& first = frame_data.scene->cloths.front();
  const double mass = first.mesh.given()
                          ? first.density * spacing_of(first) * spacing_of(first)
                          : particle_mass(first, first.grid.nx / 2, first.grid.ny / 2);
  const float weight = static_cast<float>(mass) * length(to_float(frame_data.scene->gravity));
  // Forces are drawn of one iteration, of which a substep may add several.
  const Solver& solver = frame_data.scene->solver;
  const auto repeats = static_cast<float>(solver.iterate_springs ? solver.iterations : 1);
  particle_weight_ = std::max(weight / repeats, 1e-6f);
  if (shown_scene_ != frame_data.scene_serial) {
    floor_.clear();
    if (setting.has_ground) {
      floor_center_ = setting.room.center();
      floor_center_.y = setting.ground - 1e-3f * setting.size;
      floor_.push_back(make_floor(floor_center_, 6 * setting.size));
    }
  }
  shown_scene_ = frame_data.scene_serial;
  shown_frame_ = frame_data.frame;
  shown_change_ = frame_data.change;
  shown_look_ = &look;
  shown_refinement_ = settings.refinement;
  shown_detail_ = settings.detail;
  shown_fine_ = settings.fine;
  upload_ms_ = cpu_ms() - start;
}

void Renderer::update_bodies(const FrameData& frame_data, const Setting& setting,
                             const LookSettings& settings) {
  double widest = 0;  // m, diagonal of a square of the grid
  for (const Cloth& cloth : frame_data.scene->cloths)
    widest = std::max(widest, cloth.mesh.given()
                                  ? spacing_of(cloth)
                                  : std::hypot(spacing_u(cloth.grid), spacing_v(cloth.grid)));
  if (body_tessellation_ != settings.tessellation || body_size_ != setting.size) bodies_.clear();
  body_tessellation_ = settings.tessellation;
  body_size_ = setting.size;
  std::size_t count = 0;
  for (Collider body : frame_data.bodies) {
    const Plane* plane = std::get_if<Plane>(&body.shape);
    if (plane && is_level(*plane)) continue;
    shrink(body, widest);
    const Shape shape = about_its_place(body.shape);
    if (count < bodies_.size() && bodies_[count].shape == shape) {
      bodies_[count++].collider = body;
      continue;
    }
    bodies_.erase(bodies_.begin() + static_cast<std::ptrdiff_t>(count), bodies_.end());
    bodies_.push_back({body, shape, make_body(shape, setting.size, settings.tessellation)});
    ++count;
  }
  bodies_.erase(bodies_.begin() + static_cast<std::ptrdiff_t>(count), bodies_.end());
}

void Renderer::Body::draw(const Shader& shader) const {
  shader.set("u_place", to_float(place_of(collider.shape)));
  mesh.draw();
}

// Where the camera alone has moved, the map of before serves.
void Renderer::draw_shadow_map(const FrameData& frame_data, const Setting& setting,
                               const Look& look, const LookSettings& settings) {
  shadow_map_ = &shadow_maps_.try_emplace(settings.shadow_size, settings.shadow_size).first->second;
  if (!settings.shadows) return;
  const Shadowed now{
      frame_data.scene_serial, frame_data.change,   frame_data.frame,      settings.shadow_size,
      settings.detail,         settings.refinement, settings.tessellation, &look};
  if (now == shadowed_) return;
  shadowed_ = now;
  const Bounds bounds = visible_bounds(frame_data);
  const float r = 1.02f * bounds.radius();
  const Vec3f eye = bounds.center() + kLight * (1.5f * r);
  const Mat4 light = orthographic(r, r, 3 * r + 4 * setting.size) *
                     look_at(eye, bounds.center(), any_normal(kLight));
  const Mat4 to_texture{{0.5f, 0, 0, 0, 0, 0.5f, 0, 0, 0, 0, 0.5f, 0, 0.5f, 0.5f, 0.5f, 1}};
  shadow_matrix_ = to_texture * light;
  shadow_map_->begin();
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(1.5f, 4);
  const Shader& depth = shader("shadow");
  depth.use();
  depth.set("u_light_view_projection", light);
  depth.set("u_place", Vec3f{});
  for (const ClothMesh& cloth : cloths_) cloth.draw_surface();
  for (const Body& body : bodies_)
    if (!std::holds_alternative<Plane>(body.shape)) body.draw(depth);
  glDisable(GL_POLYGON_OFFSET_FILL);
}

void Renderer::upload_frame(const Setting& setting, const LookSettings& settings,
                            const Camera& camera, float aspect) {
  FrameBlock block;
  block.view_projection = camera.projection(aspect) * camera.view();
  block.shadow_matrix = shadow_matrix_;
  const float t = std::tan(camera.fov() / 2);
  set(block.eye, camera.eye(), setting.size);
  // Small maps are coarse.
  const float coarse = std::max(1.0f, 1024.0f / static_cast<float>(settings.shadow_size));
  set(block.light, kLight, 0.0025f * setting.size * coarse);
  set(block.light_color, kLightColor,
      settings.shadows ? static_cast<float>(settings.shadow_softness) : 0.0f);
  set(block.right, camera.right() * (t * aspect), 0);
  set(block.up, camera.up() * t, 0);
  set(block.forward, camera.forward(), 0);
  glBindBuffer(GL_UNIFORM_BUFFER, frame_.id());
  glBufferData(GL_UNIFORM_BUFFER, sizeof block, &block, GL_STREAM_DRAW);
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, frame_.id());
}

void Renderer::set_material(const Shader& shader, const LookSettings& settings, bool cloth) {
  shader.use();
  shader.set("u_roughness", settings.roughness);
  shader.set("u_metallic", settings.metallic);
  shader.set("u_maps", settings.maps ? 1.0f : 0.0f);
  shader.set("u_translucency", cloth ? settings.translucency : 0.0f);
  shader.set("u_weave", static_cast<float>(settings.weave));
  shader.set("u_sheen", settings.sheen);
  shader.set("u_two_sided", cloth ? 1.0f : 0.0f);
  shader.set("u_parts", Vec3f{settings.ambient ? 1.0f : 0.0f, settings.diffuse ? 1.0f : 0.0f,
                              settings.specular ? 1.0f : 0.0f});
  shader.set("u_shininess", settings.shininess);
  shader.set("u_normal_scale", settings.normal_scale);
  shader.set("u_place", Vec3f{});
  shader.set("u_raise", 0.0f);
  shader.set("u_half_thickness", 0.0f);
  const bool heights = shader.name() == "bump" || shader.name() == "displacement";
  const float repeats = heights ? settings.height_repeats : settings.texture_repeats;
  shader.set("u_texture_scale", repeats, repeats);
  shader.set("u_force_scale", 0.25f * settings.force_scale / particle_weight_);
  shader.set("u_strain_range", settings.strain_range);
}

void Renderer::draw_ground(const Setting& setting) {
  if (floor_.empty()) return;
  const Shader& ground = shader(setting.solid ? "ground" : "grid");
  ground.use();
  ground.set("u_ground", floor_center_, 4 * setting.size);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  floor_.front().draw();
  glDisable(GL_BLEND);
}

void Renderer::draw_bodies(const Look& look, const LookSettings& settings, const Camera& camera) {
  const Shader& material = shader(look.on_colliders ? look.name : "colour");
  set_material(material, settings, false);
  for (const Body& body : bodies_) {
    // A wall between the eye and the cloth would hide what it pushes.
    const Plane* plane = std::get_if<Plane>(&body.collider.shape);
    if (plane && !in_front_of(*plane, camera.eye())) continue;
    const bool closed = !plane && !std::holds_alternative<MeshBody>(body.shape);
    material.set("u_color", color_of(body.collider));
    material.set("u_back_color", color_of(body.collider));
    if (closed) glEnable(GL_CULL_FACE);
    body.draw(material);
    glDisable(GL_CULL_FACE);
  }
}

void Renderer::draw_faces(const ClothMesh& cloth, const Shader& material, float height,
                          float thickness) {
  glEnable(GL_CULL_FACE);
  for (const auto& [hidden, side] : {std::pair(GL_FRONT, -1.0f), std::pair(GL_BACK, 1.0f)}) {
    glCullFace(static_cast<GLenum>(hidden));
    material.set("u_raise", side * height);
    material.set("u_half_thickness", side * thickness / 2);
    cloth.draw_surface();
  }
  material.set("u_raise", 0.0f);
  material.set("u_half_thickness", 0.0f);
  cloth.draw_rim();
  glDisable(GL_CULL_FACE);
}

void Renderer::draw_cloths(const FrameData& frame_data, const Look& look,
                           const LookSettings& settings, const RenderTarget& target,
                           const Setting& setting) {
  const Shader& material = shader(look.name);
  set_material(material, settings, true);
  const float spacing = setting.size / 150;
  material.set("u_point_size", spacing);
  material.set("u_pixels", static_cast<float>(target.height()) * 1.6f);
  const std::pair<bool, Vec3f> kinds[] = {{settings.structural, kStructuralColor},
                                          {settings.shear, kShearColor},
                                          {settings.bend, kBendColor}};
  for (std::size_t c = 0; c < cloths_.size(); ++c) {
    const ClothMesh& cloth = cloths_[c];
    const auto [along_u, along_v] = sides_of(frame_data.scene->cloths[c]);
    const ClothColors colors = colors_of(frame_data.scene->cloths[c], c);
    material.set("u_color", colors.front);
    material.set("u_back_color", colors.back);
    material.set("u_threads", settings.threads * along_u, settings.threads * along_v);
    const bool faces = look.raised || thicknesses_[c] > 0;
    if (look.draw == Look::Draw::surface && !faces) cloth.draw_surface();
    if (look.draw == Look::Draw::surface && faces)
      draw_faces(cloth, material, look.raised ? settings.height_scale : 0, thicknesses_[c]);
    if (look.draw == Look::Draw::points) cloth.draw_points();
    for (int kind = 0; kind < 3 && look.draw == Look::Draw::lines; ++kind) {
      if (!kinds[kind].first) continue;
      material.set("u_color", kinds[kind].second);
      cloth.draw_lines(static_cast<ClothMesh::Kind>(kind));
    }
  }
}

}  // namespace weft::viewer
