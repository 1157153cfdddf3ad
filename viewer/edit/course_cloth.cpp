#include "edit/course_cloth.h"

#include <algorithm>

namespace weft::viewer {
namespace {

constexpr double kStepsPerSecond = 2700;
constexpr double kBendingShare = 0.2;       // of ks
constexpr double kSquareCentimetres = 0.1;  // g/cm² in a kg/m²

}  // namespace

bool is_course_cloth(const Scene& scene) {
  return scene.cloths.size() == 1 && scene.solver.full_first_kick && scene.cloths[0].level == 0 &&
         !scene.cloths[0].mesh.given() && !scene.cloths[0].membrane.given();
}

CourseCloth course_cloth_of(const Scene& scene) {
  const Cloth& cloth = scene.cloths[0];
  const Kinds& k = cloth.stiffness;
  CourseCloth c;
  c.structural = k.structural > 0;
  c.shearing = k.shear > 0;
  c.bending = k.bend > 0;
  c.ks = c.structural ? k.structural : c.shearing ? k.shear : k.bend / kBendingShare;
  c.density = area_density(cloth) * kSquareCentimetres;
  c.damping = cloth.drag * 100 / kStepsPerSecond;
  c.gravity = scene.gravity[1];
  c.thickness = cloth.self_collision.thickness / 2;
  return c;
}

Scene with(Scene scene, const CourseCloth& wanted) {
  const CourseCloth now = course_cloth_of(scene);
  Cloth& cloth = scene.cloths[0];
  // Where all springs are off, ks is 0: one that is put on again has the course's.
  const double ks = wanted.ks > 0 ? wanted.ks : CourseCloth{}.ks;
  const auto set = [&](double& stiffness, bool on, bool before, double share) {
    if (on != before || wanted.ks != now.ks) stiffness = on ? share * ks : 0;
  };
  set(cloth.stiffness.structural, wanted.structural, now.structural, 1);
  set(cloth.stiffness.shear, wanted.shearing, now.shearing, 1);
  set(cloth.stiffness.bend, wanted.bending, now.bending, kBendingShare);
  if (wanted.density != now.density) {
    cloth.particle_mass =
        wanted.density / kSquareCentimetres * spacing_u(cloth.grid) * spacing_v(cloth.grid);
    cloth.masses.clear();
  }
  if (wanted.damping != now.damping) cloth.drag = wanted.damping / 100 * kStepsPerSecond;
  scene.gravity[1] = wanted.gravity;
  if (wanted.thickness != now.thickness) cloth.self_collision.thickness = 2 * wanted.thickness;
  return scene;
}

}  // namespace weft::viewer
