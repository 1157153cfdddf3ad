// The looks: their names, what each draws, and the settings that a person may change.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "picture/linear.h"

namespace weft::viewer {

struct Look {
  std::string_view name;  // of shaders/NAME.vert and .frag, and of --shader
  std::string_view about;
  bool forces = false;        // needs the force on each particle
  bool strains = false;       // needs the strain at each particle
  bool on_colliders = false;  // the colliders wear it, too; else they are plain
  bool raised = false;        // the cloth's faces rise from it, each to its side
  enum class Draw { surface, lines, points } draw = Draw::surface;
};

inline constexpr std::array kLooks{
    Look{"colour", "The cloth's colour, GGX reflection"},
    Look{"phong_force", "Direction of the force on each particle, Blinn-Phong", true},
    Look{"ggx_force", "Force on each particle, GGX", true},
    Look{"blinn_phong", "Ambient, diffuse and specular, each switchable", false, false, true},
    Look{"diffuse", "Lambert's law alone", false, false, true},
    Look{"normals", "Directions of the normals as colours", false, false, true},
    Look{"texture", "A woven texture"},
    Look{"bump", "A height map in the normals"},
    Look{"displacement", "A height map that raises the surface", false, false, false, true},
    Look{"mirror", "Reflects the sky", false, false, true},
    Look{"pbr", "Metallic-roughness material from four maps, lit by the sky's image", false, false,
         true},
    Look{"fabric", "Cloth by its weave: threads, sheen, light that comes through"},
    Look{"strain", "Heat map of the strain", false, true},
    Look{"wireframe", "Constraints in the colours of their kinds", false, false, false, false,
         Look::Draw::lines},
    Look{"points", "The particles", false, false, false, false, Look::Draw::points},
};

// The look of that name; null when there is none.
inline const Look* find_look(std::string_view name) {
  for (const Look& look : kLooks)
    if (look.name == name) return &look;
  return nullptr;
}

enum class Weave { plain, twill, satin, leather };

// How much is done for a picture: `automatic`, what is quick on this machine; `quick`, coarse while things move,
// and no more than needed at rest; `fine`, with ambient occlusion, softer shadows and the cloth's thickness.
enum class Quality { automatic, quick, standard, fine };

// The two sides of a cloth; linear.
struct ClothColors {
  Vec3f front{0.56f, 0.07f, 0.06f}, back{0.50f, 0.20f, 0.12f};
};

struct LookSettings {
  float roughness = 0.55f;
  float metallic = 0;
  bool maps = true;  // look pbr: base colour, metallic, roughness and normals from maps
  bool ambient = true, diffuse = true, specular = true;
  float shininess = 40;
  float normal_scale = 1;
  Weave weave = Weave::plain;  // look fabric
  float threads = 300;         // 1/m
  float sheen = 0.3f;          // of fibres
  float translucency = 0.22f;  // share of light that shines through
  Quality quality = Quality::automatic;
  bool fine =
      false;  // the picture that is drawn: ambient occlusion, and the cloth's thickness at its border
  float height_scale = 0.01f;  // m
  float texture_repeats = 3;   // over the cloth
  float height_repeats = 1;
  float force_scale = 1;  // colours per weight of a particle
  float strain_range = 0.1f;
  bool shadows = true;
  int shadow_softness = 3;  // samples along each side of the shadow's soft edge, 1 … 4
  int shadow_size = 2048;   // of the map of depths that shadows come from, each side
  bool ground = true;
  int tessellation = 64;  // of spheres around, 16 … 128
  int refinement = 0;     // vertices per grid cell side; 0: as many as the detail asks for
  int detail = 200;       // vertices along a side of the cloth, about

  // Constraints of the wireframe.
  bool structural = true, shear = true, bend = false;
  friend bool operator==(const LookSettings&, const LookSettings&) = default;
};

// Of the scene's cloth with this number. Where none are given, the standard ones with another hue for each, so
// that cloths are told apart.
ClothColors colors_of(const Cloth& cloth, std::size_t number);
inline constexpr Vec3f kBodyColor{0.28f, 0.30f, 0.33f};
// Of a body, or the standard one.
Vec3f color_of(const Collider& body);
// The colour that is drawn for a place of the scene, "/cloths/0/color/back" or "/colliders/0/color": "#rrggbb".
std::string drawn_color(const Scene& scene, const std::string& place);

inline constexpr Vec3f kStructuralColor{0.02f, 0.05f, 0.25f};
inline constexpr Vec3f kShearColor{0.75f, 0.20f, 0.02f};
inline constexpr Vec3f kBendColor{0.02f, 0.45f, 0.12f};

}  // namespace weft::viewer
