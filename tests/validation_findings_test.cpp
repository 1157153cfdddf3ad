// What those who wrote cloth before have seen, as numbers: their scenes and values, one test for
// each finding. Most are an order: "more than with the other value".
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <tuple>

#include "physics/model/lattice/energy.h"
#include "sheets.h"
#include "truth.h"
#include "weft/read_scene.h"

namespace weft {
namespace {

const char* const kLaw = "qualitative findings";

Scene course_scene(const std::string& scene, const std::string& key, double value) {
  return read_scene(scene, {{"/cloth/" + key, std::to_string(value)}}).scene;
}
Simulation course(const std::string& scene, const std::string& key, double value,
                  StrainLimitOrder order = StrainLimitOrder::strict) {
  Scene changed = course_scene(scene, key, value);
  changed.cloths[0].strain_limit_order = order;
  return Simulation(changed);
}

// How often the bend along a row or column changes sides, on average; bends of less than `least`
// radians from one spring to the next do not count.
double folds(const Simulation& simulation, double least) {
  const ClothView c = simulation.view().cloths[0];
  const auto at = [&](int i, int j) { return position(simulation, i, j); };
  int changes = 0;
  for (const bool down : {false, true})
    for (int line = 1; line + 1 < (down ? c.columns : c.rows); ++line)
      for (int m = 1, side = 0; m + 1 < (down ? c.rows : c.columns); ++m) {
        const int i = down ? line : m, j = down ? m : line;
        const Vec3 before = at(i - !down, j - down), here = at(i, j),
                   after = at(i + !down, j + down);
        const Vec3 normal =
            cross(minus(at(i + 1, j), at(i - 1, j)), minus(at(i, j + 1), at(i, j - 1)));
        const Vec3 turn = minus(minus(after, here), minus(here, before));
        const double bend = 2 * dot(turn, normal) / length(normal) / length(minus(after, before));
        if (std::abs(bend) < least) continue;
        changes += side * bend < 0;
        side = bend > 0 ? 1 : -1;
      }
  return double(changes) / (c.columns + c.rows - 4);
}

struct Sagged {
  double sag = 0;    // m, of the middle, at rest
  double folds = 0;  // on the way there
};

Sagged pinned_at_four_corners(const std::string& key, double value, StrainLimitOrder order) {
  Simulation simulation = course("pinned4", key, value, order);
  Sagged s;
  advance(simulation, 0.5);
  s.folds = folds(simulation, 0.03);
  advance(simulation, 1.5);
  s.sag = 1 - position(simulation, 24, 24)[1];
  return s;
}

void expect_more_sag(const std::string& what, const Sagged& softer, const Sagged& stiffer) {
  expect_above({kLaw, what + ": sag of the middle", stiffer.sag, 0.1, "m"}, softer.sag);
}
void expect_more_folds(const std::string& what, const Sagged& softer, const Sagged& stiffer) {
  expect_above({kLaw, what + ": folds along a line after 0.5 s", stiffer.folds, 0.1, ""},
               softer.folds);
}
void expect_more(const std::string& what, const Sagged& softer, const Sagged& stiffer) {
  expect_more_sag(what, softer, stiffer);
  expect_more_folds(what, softer, stiffer);
}

struct Order {
  StrainLimitOrder order;
  std::string name;
};
const Order kCourse{StrainLimitOrder::course, ", limit in the course's order"};
const Order kStrict{StrainLimitOrder::strict, ""};

TEST(Finding, LowerStiffnessSagsMoreInMoreFolds) {
  for (const auto& [order, name] : {kCourse, kStrict}) {
    std::vector<Sagged> s;
    for (const double ks : {20000, 5000, 1000})
      s.push_back(pinned_at_four_corners("ks", ks, order));
    expect_more("four pins, ks 5000 against 20000 N/m" + name, s[1], s[0]);
    expect_more("four pins, ks 1000 against 5000 N/m" + name, s[2], s[1]);
  }
}

TEST(Finding, HigherDensitySagsMoreInMoreFolds) {
  for (const auto& [order, name] : {kCourse, kStrict}) {
    std::vector<Sagged> s;
    for (const double density : {15, 150, 1000})
      s.push_back(pinned_at_four_corners("density", density, order));
    expect_more("four pins, 150 against 15 kg/m²" + name, s[1], s[0]);
    expect_more_sag("four pins, 1000 against 150 kg/m²" + name, s[2], s[1]);
    // Where the limit holds, both sheets are at it after half a second, and fold alike; the finding's
    // own values are the lightest and the heaviest.
    const Sagged& lighter = order == StrainLimitOrder::course ? s[1] : s[0];
    expect_more_folds("four pins, 1000 against a lighter sheet" + name, s[2], lighter);
  }
}

// How far the lower edge of a sheet that swings down from two pins passes the place where it comes
// to rest [m].
double overshoot(double damping) {
  Simulation simulation = course("pinned2", "damping", damping);
  double farthest = 1, z = 1;
  while (simulation.time() < 12) {
    simulation.advance_frame();
    z = position(simulation, 24, 49)[2];
    farthest = std::min(farthest, z);
  }
  EXPECT_NEAR(z, 0, 0.01);  // it hangs below its pins
  return z - farthest;
}

TEST(Finding, OnlySmallDragOvershoots) {
  expect_above({kLaw, "two pins, damping 0.1 %: beyond its resting place", 0.1, 0, "m"},
               overshoot(0.1));
  expect({kLaw, "two pins, damping 0.9 %: beyond its resting place", 0, 1e-3, "m"}, overshoot(0.9));
}

struct Draped {
  double folds = 0;      // round a circle of the sheet, as far as it reaches from the middle
  double amplitude = 0;  // m, of the circle's distance from the axis
  double start = 0;      // radii above the middle of the sphere: where the sheet first lifts off it
};

Draped draped(double ks, std::uint64_t seed) {
  Scene scene = course_scene("sphere", "ks", ks);
  scene.cloths[0].grid.jitter = 1e-5;
  Options options;
  options.seed = seed;
  Simulation simulation(scene, options);
  advance(simulation, 2);
  const Sphere& sphere = std::get<Sphere>(simulation.scene().colliders[0].shape);
  Draped d;
  for (int j = 0; j < 50; ++j)
    for (int i = 0; i < 50; ++i) {
      const Vec3 from = minus(position(simulation, i, j), sphere.center);
      if (length(from) > 1.05 * sphere.radius) d.start = std::max(d.start, from[1] / sphere.radius);
    }
  // A circle 20 spacings from the sheet's middle, within its squares.
  constexpr int kPoints = 240;
  std::array<double, kPoints> distance;
  double mean = 0;
  for (int n = 0; n < kPoints; ++n) {
    const double angle = 2 * std::numbers::pi * n / kPoints;
    const double u = 24.5 + 20 * std::cos(angle), v = 24.5 + 20 * std::sin(angle);
    const int i = int(u), j = int(v);
    double x[2] = {};
    for (const int di : {0, 1})
      for (const int dj : {0, 1}) {
        const double share = (di ? u - i : 1 - u + i) * (dj ? v - j : 1 - v + j);
        const Vec3 corner = minus(position(simulation, i + di, j + dj), sphere.center);
        x[0] += share * corner[0];
        x[1] += share * corner[2];
      }
    distance[std::size_t(n)] = std::hypot(x[0], x[1]);
    mean += distance[std::size_t(n)] / kPoints;
  }
  for (const double r : distance) d.amplitude += (r - mean) * (r - mean) / kPoints;
  d.amplitude = std::sqrt(d.amplitude);
  // Out and in again by a third of the amplitude is a fold.
  bool out = false;
  for (int n = 0; n < 2 * kPoints; ++n) {
    const double r = distance[std::size_t(n % kPoints)] - mean;
    if (std::abs(r) < d.amplitude / 3) continue;
    d.folds += n >= kPoints && out != (r > 0) ? 0.5 : 0;
    out = r > 0;
  }
  return d;
}

// How a sheet folds hangs on the last bit of where it starts: the middle ones of five.
Draped draped(double ks) {
  std::array<Draped, 5> all;
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = draped(ks, i + 1);
  const auto middle = [&](double Draped::*what) {
    std::array<double, all.size()> values;
    for (std::size_t i = 0; i < all.size(); ++i) values[i] = all[i].*what;
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
  };
  return {middle(&Draped::folds), middle(&Draped::amplitude), middle(&Draped::start)};
}

TEST(Finding, StifferSheetHasFewerLargerFoldsOverASphereThatStartHigher) {
  const Draped soft = draped(500), middle = draped(5000), stiff = draped(50000);
  for (const auto& [what, softer, stiffer] :
       {std::tuple{"over a sphere, median of five starts, ks 500 against 5000 N/m", soft, middle},
        std::tuple{"over a sphere, median of five starts, ks 5000 against 50000 N/m", middle,
                   stiff}}) {
    const std::string name = what;
    expect_above({kLaw, name + ": folds", stiffer.folds, 0.1, ""}, softer.folds);
  }
  for (const auto& [what, softer, stiffer] :
       {std::tuple{"over a sphere, median of five starts, ks 5000 against 500 N/m", soft, middle},
        std::tuple{"over a sphere, median of five starts, ks 50000 against 5000 N/m", middle,
                   stiff}}) {
    const std::string name = what;
    expect_above({kLaw, name + ": depth of the folds", softer.amplitude, 0.1, "m"},
                 stiffer.amplitude);
    expect_above({kLaw, name + ": height where they start", softer.start, 0.1, "radii"},
                 stiffer.start);
  }
}

// Share of the particles that lie on another part of the sheet: within one and a half thicknesses
// of a particle that is more than five places away.
double folded_on_itself(const Simulation& simulation) {
  const Cloth& cloth = simulation.scene().cloths[0];
  const double reach = 1.5 * cloth.self_collision.thickness;
  const int nx = cloth.grid.nx, count = nx * cloth.grid.ny;
  int touching = 0;
  for (int p = 0; p < count; ++p) {
    const Vec3 here = position(simulation, p % nx, p / nx);
    bool touches = false;
    for (int q = 0; q < count && !touches; ++q)
      if (std::max(std::abs(p % nx - q % nx), std::abs(p / nx - q / nx)) > 5)
        touches = length(minus(position(simulation, q % nx, q / nx), here)) < reach;
    touching += touches;
  }
  return double(touching) / count;
}

// Pairs separated at once fold the soft sheet more than the course's soft push does.
TEST(Finding, FallingSheetEndsFoldedOnItselfOrInFewLargeFolds) {
  const auto folds_along_lines = [](const Simulation& simulation) {
    return folds(simulation, 0.2);
  };
  for (const auto& [response, name, times_more] :
       {std::tuple(SelfCollisionResponse::course, "course", 0.5),
        {SelfCollisionResponse::stiff, "stiff", 1.0}}) {
    Scene soft = course_scene("selfCollision", "ks", 500),
          stiff = course_scene("selfCollision", "ks", 50000);
    soft.cloths[0].self_collision.response = stiff.cloths[0].self_collision.response = response;
    const std::string what = std::string("upright sheet falls, response ") + name + ", ks 500";
    const auto [folded, soft_folds] =
        medians_of_starts(soft, 4, folded_on_itself, folds_along_lines);
    const auto [stiff_folds] = medians_of_starts(stiff, 4, folds_along_lines);
    expect_above(
        {kLaw, what + ": particles on another part of it, median of some starts", 0.5, 0, ""},
        folded);
    expect_above({kLaw, what + " against 50000: folds along a line, median of some starts",
                  stiff_folds, times_more, ""},
                 soft_folds);
  }
}

// A strip hangs from its stiff end, all of its weight in the other: a spring of row j bears the
// same load, and is stiff by 1 - gradient (j + ½)/(n - 1). (Under the strip's own weight alone the
// load falls faster than any stiffness: then the top stretches most.)
TEST(Finding, StiffnessGradientStretchesLeastAtTheTop) {
  constexpr int nx = 3, ny = 21;
  constexpr double kGradient = 0.4, kStiffness = 200, kLoad = 0.05, kSpacing = 1.0 / (ny - 1);
  Scene scene;
  scene.cloths.emplace_back();
  Cloth& cloth = scene.cloths[0];
  cloth.grid = {nx, ny, {0, 0, 0}, {0.1, 0, 0}, {0, -1, 0}, 0};
  cloth.stiffness = {kStiffness, 0, 0};
  cloth.stiffness_gradient = kGradient;
  cloth.drag = 4;
  cloth.masses.assign(nx * ny, 1e-5);
  for (int i = 0; i < nx; ++i) {
    cloth.masses[std::size_t((ny - 1) * nx + i)] = kLoad;
    cloth.pins.push_back({i, 0, {}});
  }
  Simulation simulation(scene);
  advance(simulation, 8);
  const auto strain = [&](int j) {
    return (position(simulation, 1, j)[1] - position(simulation, 1, j + 1)[1]) / kSpacing - 1;
  };
  const auto truth = [&](int j) {
    const double k = kStiffness * (1 - kGradient * (j + 0.5) / (ny - 1));
    return 9.81 * (kLoad + 1e-5 * (ny - 2 - j)) / k / kSpacing;
  };
  const std::string what = "stiffness gradient 0.4, load at the lower edge: strain ";
  expect({kLaw, what + "at the top", truth(0), 1e-3, ""}, strain(0));
  expect({kLaw, what + "at the bottom", truth(ny - 2), 1e-3, ""}, strain(ny - 2));
  double least = 1e9;
  for (int j = 1; j + 1 < ny; ++j) least = std::min(least, strain(j));
  expect_above({kLaw, what + "anywhere else than at the top", strain(0), 0.01, ""}, least);
}

// The springs' force on each particle, which the force looks paint: at rest its weight, and at the
// pins that of the sheet.
TEST(Finding, LargestForceIsAtThePins) {
  Scene scene = read_scene("swing").scene;
  scene.cloths[0].drag = 4;
  Simulation simulation(scene);
  const Cloth& cloth = scene.cloths[0];
  const int nx = cloth.grid.nx;
  const auto forces = [&] {
    std::vector<Vec3> x;
    for (int j = 0; j < cloth.grid.ny; ++j)
      for (int i = 0; i < nx; ++i) x.push_back(position(simulation, i, j));
    return physics::spring_forces(cloth, physics::stencils_of(cloth), x, nullptr);
  };
  const auto compare = [&](const std::string& what) {
    std::vector<Vec3> f = forces();
    double at_pins = 1e9, elsewhere = 0;
    for (const Pin& pin : cloth.pins) {
      Vec3& force = f[std::size_t(pin.j * nx + pin.i)];
      at_pins = std::min(at_pins, length(force));
      force = {};
    }
    for (const Vec3& force : f) elsewhere = std::max(elsewhere, length(force));
    expect_above({kLaw, what + ": force at the pins against any other", elsewhere, 1, "N"},
                 at_pins);
  };
  advance(simulation, 0.3);
  compare("sheet swings from two pins, after 0.3 s");
  advance(simulation, 8);
  compare("sheet hangs from two pins");
  double borne = 0, weight = 0;
  const std::vector<Vec3> f = forces();
  for (int p = 0; p < nx * cloth.grid.ny; ++p)
    weight += 9.81 * particle_mass(cloth, p % nx, p / nx);
  for (const Pin& pin : cloth.pins) {
    borne -= f[std::size_t(pin.j * nx + pin.i)][1];
    weight -= 9.81 * particle_mass(cloth, pin.i, pin.j);
  }
  expect({kLaw, "sheet hangs from two pins: force of the pins", weight, 1e-3, "N"}, borne);
}

}  // namespace
}  // namespace weft
