// The sheets (sheets.h): curtain and fabrics like it, a drape, a cantilever, a twisted strip.
#include "sheets.h"

#include <cmath>
#include <cstdio>
#include <numbers>

#include "elastica.h"

namespace bench {
namespace {

weft::Scene scene_of(double seconds, const weft::Vec3& gravity, const weft::Cloth& cloth) {
  weft::Scene scene;
  scene.gravity = gravity;
  scene.time.seconds = seconds;
  scene.cloths.push_back(cloth);
  return scene;
}

weft::Cloth springs(double structural, double shear, double bending) {
  weft::Cloth cloth;
  cloth.stiffness = {structural, shear, 0};
  cloth.bending = bending;
  return cloth;
}

weft::Cloth membrane(const weft::Membrane& stiffness, double bending) {
  weft::Cloth cloth;
  cloth.membrane = stiffness;
  cloth.bending = bending;
  return cloth;
}

// A square metre, held along one side, falls for half a second.
weft::Scene hung(weft::Cloth cloth, int n) {
  cloth.grid = {n, n, {0, 0, 0}, {1, 0, 0}, {0, 0, 1}, 0};
  cloth.drag = 1;
  for (int j = 0; j < n; ++j) cloth.pins.push_back({0, j, {}});
  return scene_of(0.5, {2, -9, 3}, cloth);
}

Sheet curtain(const std::string& name, const std::string& about, const weft::Cloth& cloth,
              std::optional<weft::Kinds> springs) {
  Sheet s;
  s.name = name;
  s.about = about;
  s.seconds = 0.5;
  s.sizes = {9, 17, 33, 65, 129};
  s.make = [cloth](int n) { return hung(cloth, n); };
  s.springs = springs;
  s.middle = 129;
  s.known = 2e-6;
  return s;
}

// It lies on the top of a ball, bends down over it and slides down with it. Its rigidity keeps it from folds,
// which would let any error decide where they come.
Sheet drape() {
  Sheet s;
  s.name = "drape";
  s.about =
      "a sheet of 0.6 m laid on a ball of 0.4 m radius bends down over it and slides, friction "
      "0.3, 0.25 s; "
      "springs: structural 200, shear 100 N/m; D = 0.02 N m";
  s.seconds = 0.25;
  s.sizes = {9, 17, 33, 65};
  s.make = [](int n) {
    weft::Cloth cloth = springs(200, 100, 0.02);
    cloth.grid = {n, n, {-0.3, 0.4, -0.3}, {0.6, 0, 0}, {0, 0, 0.6}, 0};
    cloth.drag = 1;
    weft::Scene scene = scene_of(0.25, {2, -9, 3}, cloth);
    weft::Collider ball;
    ball.shape = weft::Sphere{{0, 0, 0}, 0.4};
    ball.friction = {weft::FrictionModel::coulomb, 0.3, 0.3};
    scene.colliders.push_back(ball);
    return scene;
  };
  s.springs = weft::Kinds{200, 100, 0};
  s.without_bullet = "its links have no rigidity, which keeps this sheet from folds";
  s.middle = 65;
  s.known = 1e-6;
  s.halvings = 3;
  return s;
}

// A strip of 0.3 m clamped level at one end, after 3 s of hanging down with a drag that has stilled it. The first
// two columns hold it: the tangent is level halfway between them, where its length begins.
Sheet cantilever() {
  constexpr double kLength = 0.3, kWidth = 0.075, kDensity = 0.3, kGravity = 9.81;
  constexpr double kWarp = 1000, kRigidity = 8e-3;
  Sheet s;
  s.name = "cantilever";
  s.about =
      "a strip of 0.3 m clamped level at one end hangs at rest, after 3 s with drag; membrane: C11 "
      "= C22 = 1000, "
      "C66 = 500 N/m; D = 8e-3 N m";
  s.seconds = 3;
  s.sizes = {9, 17, 33, 65};
  s.make = [](int n) {
    weft::Cloth cloth = membrane({kWarp, kWarp, 0, 500, 0}, kRigidity);
    const double h = kLength / (n - 1.5);
    cloth.grid = {n, (n - 1) / 4 + 1, {-h / 2, 0, 0}, {h * (n - 1), 0, 0}, {0, 0, kWidth}, 0};
    cloth.density = kDensity;
    cloth.drag = 8;
    for (int j = 0; j < cloth.grid.ny; ++j)
      for (const int i : {0, 1}) cloth.pins.push_back({i, j, {}});
    return scene_of(3, {0, -kGravity, 0}, cloth);
  };
  s.springs = weft::Kinds{kWarp, 0, 0};
  s.without_bullet = "its links have no rigidity, and nothing else holds this strip up";
  s.limit = [](const weft::Grid& g) {
    std::vector<double> along, all;
    for (int i = 0; i < g.nx; ++i) along.push_back(g.origin[0] + i * weft::spacing_u(g));
    along.back() = kLength;
    const std::vector<StripPoint> strip =
        strip_at_rest({kLength, kDensity * kGravity, kRigidity, kWarp}, along);
    for (int j = 0; j < g.ny; ++j)
      for (const StripPoint& p : strip)
        all.insert(all.end(), {p.along, p.up, kWidth * j / (g.ny - 1)});
    return all;
  };
  s.limit_error = 1e-6;
  return s;
}

// Turned by an eighth each way; the ends start and stop softly. Turned further, it wrinkles.
Sheet twist() {
  constexpr double kSeconds = 0.5, kLength = 1, kWidth = 0.25;
  Sheet s;
  s.name = "twist";
  s.about =
      "a strip of 1 m x 0.25 m whose ends are held and turned against each other by a quarter in "
      "0.5 s, drag 4/s; "
      "springs: structural 1000, shear 500 N/m; D = 0.02 N m";
  s.seconds = kSeconds;
  s.sizes = {9, 17, 33, 65};
  s.make = [](int n) {
    weft::Cloth cloth = springs(1000, 500, 0.02);
    cloth.grid = {n, (n - 1) / 4 + 1, {0, 0, 0}, {kLength, 0, 0}, {0, 0, kWidth}, 0};
    cloth.drag = 4;
    for (const int end : {0, 1}) {
      weft::Rotation turn{{1, 0, 0}, {0, 0, kWidth / 2}, {}};
      constexpr int kKeys = 32;
      for (int k = 0; k <= kKeys; ++k) {
        const double part = (1 - std::cos(std::numbers::pi * k / kKeys)) / 2;
        turn.keys.push_back({kSeconds * k / kKeys, (end == 0 ? 45 : -45) * part});
      }
      for (int j = 0; j < cloth.grid.ny; ++j)
        cloth.pins.push_back({end == 0 ? 0 : n - 1, j, {}, turn});
    }
    return scene_of(kSeconds, {0, -9.81, 0}, cloth);
  };
  s.springs = weft::Kinds{1000, 500, 0};
  s.middle = 65;
  s.known = 2e-6;
  return s;
}

}  // namespace

const std::vector<Sheet>& sheets() {
  static const std::vector<Sheet> all{
      curtain("curtain", "springs: structural 1000, shear 500 N/m; D = 1e-3 N m",
              springs(1000, 500, 1e-3), weft::Kinds{1000, 500, 0}),
      curtain("curtain_membrane", "membrane: C11 = C22 = 1500, C12 = C66 = 500 N/m; D = 1e-3 N m",
              membrane({1500, 1500, 500, 500, 0}, 1e-3), weft::Kinds{1000, 500, 0}),
      curtain("woven", "membrane: C11 = 3000, C22 = 2000, C12 = 200, C66 = 80 N/m; D = 2e-4 N m",
              membrane({3000, 2000, 200, 80, 0}, 2e-4), {}),
      drape(),
      cantilever(),
      twist(),
  };
  return all;
}

Problem problem_of(const Sheet& sheet, int points) {
  Problem p;
  p.name = sheet.name;
  p.about = sheet.about;
  p.size = points;
  p.question.seconds = sheet.seconds;
  p.question.tolerance = sheet.known;
  p.question.most_halvings = sheet.halvings;
  p.question.scene = sheet.make(points);
  return p;
}

}  // namespace bench
