// Draws a frame: shadow map, background, floor, colliders, cloth.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "picture/camera.h"
#include "picture/look.h"
#include "picture/meshes.h"
#include "picture/occlusion.h"
#include "picture/render_target.h"
#include "picture/setting.h"
#include "picture/shader.h"

namespace weft::viewer {

// The user's files in the place of the program's own pictures; "" = the program's own.
struct PictureFiles {
  std::string texture, height_map, sky;
  std::array<std::string, 4> material;  // in the order of MaterialMap
  friend bool operator==(const PictureFiles&, const PictureFiles&) = default;
};

class Renderer {
 public:
  explicit Renderer(const PictureFiles& files);

  // Into the target, resolved. A new frame is uploaded, one drawn before is not.
  void draw(const FrameData& frame_data, const Setting& setting, const Look& look,
            const LookSettings& settings, const Camera& camera, const RenderTarget& target);

  // Reads the files that are others than before. Where one cannot be read, the picture before stays.
  void set_pictures(const PictureFiles& files);
  // Compiles shaders whose files have changed; true when there is a new one.
  bool reload_changed();
  // What is wrong with shaders and pictures; the last good ones are in use.
  std::vector<std::string> problems() const;

  double upload_ms() const { return upload_ms_; }  // the processor's own work for the last upload

 private:
  const Shader& shader(std::string_view name);
  void update_meshes(const FrameData& frame_data, const Setting& setting, const Look& look,
                     const LookSettings& settings);
  void update_bodies(const FrameData& frame_data, const Setting& setting,
                     const LookSettings& settings);
  void draw_shadow_map(const FrameData& frame_data, const Setting& setting, const Look& look,
                       const LookSettings& settings);
  void upload_frame(const Setting& setting, const LookSettings& settings, const Camera& camera,
                    float aspect);
  void set_material(const Shader& shader, const LookSettings& settings, bool cloth);
  void draw_ground(const Setting& setting);
  void draw_bodies(const Look& look, const LookSettings& settings, const Camera& camera);
  // The two faces of a cloth, each raised to its side by half of the thickness and up to `height` [m] more, and the
  // rim between them.
  static void draw_faces(const ClothMesh& cloth, const Shader& material, float height,
                         float thickness);
  void draw_cloths(const FrameData& frame_data, const Look& look, const LookSettings& settings,
                   const RenderTarget& target, const Setting& setting);

  std::filesystem::path folder_;
  std::map<std::string, Shader, std::less<>> shaders_;
  std::map<int, ShadowMap> shadow_maps_;   // by size
  const ShadowMap* shadow_map_ = nullptr;  // as drawn last
  // Of what the shadow map was drawn.
  struct Shadowed {
    std::uint64_t scene = ~std::uint64_t{0}, change = 0;
    std::int64_t frame = -1;
    int size = 0, detail = 0, refinement = 0, tessellation = 0;
    const Look* look = nullptr;
    friend bool operator==(const Shadowed&, const Shadowed&) = default;
  } shadowed_;
  PictureFiles files_;
  Texture texture_, height_map_, sky_;
  std::array<Texture, 4> material_;              // in the order of MaterialMap
  std::array<std::string, 7> picture_problems_;  // of the pictures; "" where there is none
  Buffer frame_;
  Occlusion occlusion_;
  VertexArray nothing_;  // for the background's triangle

  std::vector<ClothMesh> cloths_;
  std::vector<float> thicknesses_;  // m, as drawn; 0: a surface
  struct Body {
    Collider collider;  // where it stands
    Shape shape;        // about its place, as the mesh is
    BodyMesh mesh;
    void draw(const Shader& shader) const;
  };
  std::vector<Body> bodies_;
  int body_tessellation_ = 0;
  float body_size_ = 0;          // m, of planes
  std::vector<BodyMesh> floor_;  // one or none
  Vec3f floor_center_{};
  Mat4 shadow_matrix_;
  float particle_weight_ = 1;  // N, of the cloth that is drawn
  double upload_ms_ = 0;

  // What is uploaded.
  std::uint64_t shown_scene_ = ~std::uint64_t{0};
  std::int64_t shown_frame_ = -1;
  std::uint64_t shown_change_ = 0;
  const Look* shown_look_ = nullptr;
  int shown_refinement_ = -1, shown_detail_ = 0;
  bool shown_fine_ = false;
};

}  // namespace weft::viewer
