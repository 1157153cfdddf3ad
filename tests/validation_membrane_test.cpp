// The square spring grid as a membrane: stiffnesses C11, C12, C66 and what follows from them,
// against the closed forms C11 = kn + kd + 4 kb and C12 = C66 = kd of its structural, shear and
// bend springs.
//
// A free sheet is strained evenly. Nothing but its border is then out of balance: what half of a
// row, or of a column, gains in momentum at once is the tension across the middle, times the
// spacing.
#include <cmath>
#include <numbers>

#include "sheets.h"
#include "truth.h"

namespace weft {
namespace {

// Strains, or tensions [N/m].
struct Plane2 {
  double xx = 0, yy = 0, xy = 0;  // xy of a strain: half the angle of shear
};

// What there is of it along a direction.
double along(const Plane2& t, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return t.xx * c * c + t.yy * s * s + 2 * t.xy * c * s;
}

// The strain e along a direction and f across it.
Plane2 strain_along(double angle, double e, double f) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {e * c * c + f * s * s, e * s * s + f * c * c, (e - f) * c * s};
}

Plane2 tension_at(const Kinds& stiffness, const Plane2& strain) {
  constexpr int n = 33, kFrom = 8, kTo = 24;  // rows and columns far from the border
  constexpr double h = 1.0 / (n - 1), kMass = 0.01, kDt = 1e-5;
  Scene scene;
  scene.gravity = {0, 0, 0};
  scene.time = {kDt, 1, 1};
  scene.cloths.emplace_back();
  Cloth& cloth = scene.cloths[0];
  cloth.grid = {n, n, {-0.5, -0.5, 0}, {1, 0, 0}, {0, 1, 0}, 0};
  cloth.particle_mass = kMass;
  cloth.stiffness = stiffness;
  Simulation simulation(scene);
  std::vector<double> x = simulation.positions();
  for (std::size_t p = 0; p < x.size(); p += 3) {
    const double a = x[p], b = x[p + 1];
    x[p] += strain.xx * a + strain.xy * b;
    x[p + 1] += strain.xy * a + strain.yy * b;
  }
  simulation.set_state(x, std::vector<double>(x.size(), 0.0));
  simulation.advance_frame();
  const std::vector<double> v = simulation.velocities();
  Plane2 tension;
  for (int line = kFrom; line < kTo; ++line)
    for (int m = n / 2; m < n; ++m) {
      const auto in_row = 3 * std::size_t(line * n + m), in_column = 3 * std::size_t(m * n + line);
      tension.xx -= v[in_row];
      tension.yy -= v[in_column + 1];
      tension.xy -= (v[in_row + 1] + v[in_column]) / 2;
    }
  const double scale = kMass / kDt / h / (kTo - kFrom);
  return {scale * tension.xx, scale * tension.yy, scale * tension.xy};
}

// Tensions per strain: half the difference of a stretch and an equal contraction, of half a percent
// each, in which errors of first order in the strain cancel.
Plane2 tension_of(const Kinds& stiffness, const Plane2& strain) {
  constexpr double e = 0.005;
  const Plane2 more = tension_at(stiffness, {e * strain.xx, e * strain.yy, e * strain.xy});
  const Plane2 less = tension_at(stiffness, {-e * strain.xx, -e * strain.yy, -e * strain.xy});
  return {(more.xx - less.xx) / (2 * e), (more.yy - less.yy) / (2 * e),
          (more.xy - less.xy) / (2 * e)};
}

constexpr double kGoal = 1e-3;

TEST(Membrane, SpringsHaveTheStiffnessesOfTheClosedForms) {
  for (const Kinds& k : {Kinds{100, 0, 0}, {100, 50, 0}, {100, 30, 20}}) {
    char text[64];
    std::snprintf(text, sizeof text, "kn %g, kd %g, kb %g: ", k.structural, k.shear, k.bend);
    const std::string law = "membrane of springs", what = text;
    const Plane2 stretched = tension_of(k, {1, 0, 0}), sheared = tension_of(k, {0, 0, 0.5});
    expect({law, what + "C11", k.structural + k.shear + 4 * k.bend, kGoal, "N/m"}, stretched.xx);
    expect({law, what + "C12", k.shear, kGoal, "N/m"}, stretched.yy);
    expect({law, what + "C66", k.shear, kGoal, "N/m"}, sheared.xy);
  }
}

// kn = ¾ E₂D and kd = ⅜ E₂D: ν = 1/3, and no direction is stiffer than another.
TEST(Membrane, IsIsotropicWithHalfAsStiffDiagonals) {
  constexpr double kE2D = 200, kNu = 1 / 3.0;
  const Kinds k = {0.75 * kE2D, 0.375 * kE2D, 0};
  const Plane2 stretched = tension_of(k, {1, 0, 0});
  const std::string law = "isotropic membrane, kn = ¾ E₂D, kd = ⅜ E₂D";
  expect({law, "ν", kNu, kGoal, ""}, stretched.yy / stretched.xx);
  for (const double degrees : {0.0, 45.0, 20.0}) {
    const double angle = degrees * std::numbers::pi / 180;
    const Plane2 pulled = tension_of(k, strain_along(angle, 1, -kNu));
    const std::string what = "pulled at " + std::to_string(int(degrees)) + "° to the grid: ";
    expect({law, what + "E₂D", kE2D, kGoal, "N/m"}, along(pulled, angle));
    expect({law, what + "tension across", 0, kGoal, "E₂D"},
           along(pulled, angle + std::numbers::pi / 2) / kE2D);
  }
}

}  // namespace
}  // namespace weft
