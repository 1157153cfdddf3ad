#include "random_parts.h"

#include <algorithm>
#include <utility>

#include "weft/shape.h"

namespace fuzz {

using namespace weft;

namespace {

double dot(const Vec3& a, const Vec3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

}  // namespace

double length(const Vec3& a) {
  return std::hypot(a[0], a[1], a[2]);
}

Vec3 plus(const Vec3& a, const Vec3& b, double times) {
  Vec3 sum;
  for (std::size_t k = 0; k < 3; ++k)
    sum[k] = std::clamp(a[k] + times * b[k], -kFarthest, kFarthest);
  return sum;
}

Extent extent_of(const Grid& g) {
  return {g.origin, plus(plus(g.origin, g.u, 0.5), g.v, 0.5), std::max(length(g.u), length(g.v)),
          std::min(spacing_u(g), spacing_v(g))};
}

Parts::Parts(Draw& draw) : draw_(draw) {
  richness_ = draw_.of({0.15, 0.5, 1.0, 1.0, 1.6});
  spacing_ = draw_.chance(0.9) ? draw_.decades(0.003, 0.3) : draw_.decades(1e-5, 30);
  if (some(0.15)) place_ = draw_.vector(draw_.decades(1, kFarthest));
}

Time Parts::time() {
  Time t;
  if (some(0.3)) t.frame = draw_.chance(0.8) ? draw_.decades(1e-3, 0.1) : draw_.decades(1e-5, 1);
  if (draw_.chance(0.6)) t.substeps = draw_.between(1, draw_.of({4, 20, 60, 300}));
  return t;
}

Solver Parts::solver() {
  Solver s;
  if (draw_.chance(0.75)) s.method = static_cast<Method>(draw_.between(0, 3));
  const bool projects = s.method == Method::positional || s.method == Method::compliant;
  if (projects) s.sweep = static_cast<Sweep>(draw_.between(0, 2));
  s.tethers = projects && some(0.25);
  if (s.method == Method::compliant && s.sweep != Sweep::jacobi) s.order = draw_.between(1, 2);
  if (some(0.4)) s.iterations = draw_.between(1, draw_.of({3, 10, 60}));
  if (some(0.2)) s.collision_iterations = draw_.between(1, draw_.of({3, 20}));
  if (some(0.2)) s.sleep = draw_.of({draw_.decades(1e-4, 1), 1.0, 1e-300});
  return s;
}

Vec3 Parts::gravity() {
  if (!some(0.3)) return {0, -9.81, 0};
  if (draw_.chance(0.4)) return {};
  return draw_.vector(draw_.chance(0.9) ? draw_.decades(0.1, 100) : kFarthest);
}

Wind Parts::wind() {
  Wind w;
  if (!some(0.2)) return w;
  w.velocity = draw_.vector(draw_.chance(0.9) ? draw_.decades(0.1, 30) : 1000);
  if (draw_.chance(0.8)) w.drag = draw_.chance(0.9) ? draw_.decades(0.01, 3) : 1000;
  if (draw_.chance(0.5)) w.lift = draw_.chance(0.9) ? draw_.decades(0.01, 3) : 1000;
  if (draw_.chance(0.4)) w.turbulence = draw_.uniform(0, 1);
  return w;
}

// Lanes come in 4, 8 and 16: points a little above and below those are frequent.
void Parts::points(Grid& g) {
  const double kind = draw_.uniform(0, 1);
  if (kind < 0.55) {
    g.nx = draw_.between(2, 12), g.ny = draw_.between(2, 12);
  } else if (kind < 0.8) {
    g.nx = draw_.between(2, 24), g.ny = draw_.between(2, 24);
  } else if (kind < 0.97) {
    g.nx = draw_.between(2, 3), g.ny = draw_.between(2, 70);
    if (draw_.chance(0.5)) std::swap(g.nx, g.ny);
  } else {
    g.nx = draw_.between(30, 70), g.ny = draw_.between(30, 50);
  }
}

// Along the axes, or in any direction and at any angle.
void Parts::sides(Grid& g) {
  const double du = spacing_ * (some(0.3) ? draw_.decades(0.1, 10) : 1);
  const double dv = spacing_ * (some(0.3) ? draw_.decades(0.1, 10) : 1);
  g.u = {1, 0, 0};
  g.v = draw_.chance(0.5) ? Vec3{0, 0, 1} : Vec3{0, -1, 0};
  if (draw_.chance(0.3)) g.u = draw_.vector(1), g.v = draw_.vector(1);
  const double lu = std::max(length(g.u), 1e-3), lv = std::max(length(g.v), 1e-3);
  for (std::size_t k = 0; k < 3; ++k) {
    g.u[k] = std::clamp(g.u[k] / lu * du * (g.nx - 1), -kFarthest, kFarthest);
    g.v[k] = std::clamp(g.v[k] / lv * dv * (g.ny - 1), -kFarthest, kFarthest);
  }
}

Grid Parts::grid() {
  Grid g;
  points(g);
  sides(g);
  g.origin = plus(place_, draw_.chance(0.5) ? Vec3{} : draw_.vector(extent_of(g).size));
  if (some(0.25))
    g.jitter = std::min(1.0, spacing_ * (draw_.chance(0.9) ? draw_.decades(1e-4, 1) : 20));
  return g;
}

double Parts::stiffness() {
  const double kind = draw_.uniform(0, 1);
  if (kind < 0.6) return draw_.decades(1, 1e4);
  if (kind < 0.75) return 0;
  if (kind < 0.93) return draw_.decades(1e-6, 1e8);
  return draw_.of({5e-324, 1e-310, 1e-42, 1e-30, 1e9});
}

void Parts::masses(Cloth& c) {
  const auto particles = static_cast<std::size_t>(c.grid.nx) * static_cast<std::size_t>(c.grid.ny);
  c.density = draw_.chance(0.9) ? draw_.decades(0.02, 2) : draw_.decades(1e-5, 1e5);
  if (some(0.2)) c.particle_mass = draw_.decades(1e-6, 1);
  if (!some(0.15)) return;
  const double one = draw_.decades(1e-5, 1), spread = draw_.decades(1, 1e3);
  for (std::size_t p = 0; p < particles; ++p) c.masses.push_back(one * draw_.decades(1, spread));
}

void Parts::limits(Cloth& c) {
  if (some(0.25)) c.strain_limit = draw_.decades(1e-4, 10);
  if (some(0.4))
    c.strain_limit_order = draw_.of({StrainLimitOrder::course, StrainLimitOrder::strict});
  if (some(0.2)) c.tear_strain = draw_.decades(1e-3, 10);
  if (draw_.chance(0.3)) c.tears = draw_.of({Tears::holes, Tears::particles});
}

// Over the sheet and past its borders.
std::vector<CutLine> Parts::cuts(const Grid& g) {
  std::vector<CutLine> cuts(some(0.15) ? static_cast<std::size_t>(draw_.between(1, 3)) : 0);
  for (CutLine& line : cuts)
    for (int n = draw_.between(2, 5); n > 0; --n)
      line.push_back({draw_.uniform(-2, g.nx + 1), draw_.uniform(-2, g.ny + 1)});
  return cuts;
}

SelfCollision Parts::self_collision(const Grid& g) {
  SelfCollision s;
  if (!some(0.4)) return s;
  const double spacing = std::min(spacing_u(g), spacing_v(g));
  s.mode = draw_.chance(0.5) ? SelfCollisionMode::particles : SelfCollisionMode::surface;
  s.thickness = std::clamp(spacing * draw_.decades(0.05, 4), 1e-5, 1.0);
  if (draw_.chance(0.4))
    s.response = draw_.of({SelfCollisionResponse::course, SelfCollisionResponse::neighbours});
  if (draw_.chance(0.5)) s.friction = draw_.of({0.0, 10.0, draw_.uniform(0, 2)});
  return s;
}

// The first key lies where the thing is, near there or far away; at the start or late.
std::vector<Key> Parts::path(const Vec3& start, double size, double frame) {
  std::vector<Key> keys;
  const double begin = draw_.uniform(0, 1);
  Vec3 at = start;
  if (begin > 0.5) at = plus(start, draw_.vector(size * draw_.decades(0.01, 3)));
  if (begin > 0.8) at = draw_.of({Vec3{}, draw_.vector(100 * size), draw_.vector(1)});
  if (begin > 0.97) at = draw_.vector(kFarthest);
  double time = draw_.chance(0.6) ? 0 : frame * draw_.decades(0.1, 30);
  const int count = draw_.chance(0.97) ? draw_.between(1, 5) : draw_.between(50, 300);
  for (int n = 0; n < count; ++n) {
    keys.push_back({time, at});
    at = plus(at, draw_.vector(size * draw_.decades(1e-3, 3)));
    time += frame * draw_.decades(0.01, 20);
  }
  return keys;
}

std::vector<Pin> Parts::grid_pins(const Grid& g, const Time& time) {
  std::vector<Pin> pins;
  const auto pin = [&](int i, int j) {
    if (std::any_of(pins.begin(), pins.end(), [&](const Pin& p) { return p.i == i && p.j == j; }))
      return;
    pins.push_back({i, j, {}});
    const Vec3 here =
        plus(plus(g.origin, g.u, double(i) / (g.nx - 1)), g.v, double(j) / (g.ny - 1));
    if (some(0.25)) pins.back().keys = path(here, extent_of(g).size, time.frame);
  };
  const double kind = draw_.uniform(0, 1);
  if (kind < 0.3) return pins;
  if (kind < 0.5) {
    pin(0, 0), pin(g.nx - 1, 0);
  } else if (kind < 0.6) {
    for (int i = 0; i < g.nx; ++i) pin(i, 0);
  } else if (kind < 0.65) {
    for (int j = 0; j < g.ny; ++j) pin(0, j);
  } else {
    for (int n = draw_.between(1, kind < 0.95 ? 4 : 40); n > 0; --n) {
      const int i = draw_.between(0, g.nx - 1);  // one after the other: arguments have no order
      pin(i, draw_.between(0, g.ny - 1));
    }
  }
  return pins;
}

std::vector<Pin> Parts::pins(const Cloth& c, const Time& time) {
  return c.mesh.given() ? vertex_pins(c, time) : grid_pins(c.grid, time);
}

Rotation Parts::rotation(const Vec3& near, double size, double frame) {
  Rotation r;
  r.axis = draw_.vector(draw_.decades(1e-3, 1e3));
  r.about = weft::plus(near, draw_.vector(size));
  double time = draw_.chance(0.6) ? 0 : frame * draw_.decades(0.1, 30);
  double degrees = draw_.chance(0.5) ? 0 : draw_.uniform(-3600, 3600);
  for (int n = draw_.between(1, 4); n > 0; --n) {
    r.keys.push_back({time, degrees});
    time += frame * draw_.decades(0.01, 20);
    degrees += draw_.uniform(-90, 90);
  }
  return r;
}

void Parts::add_motion(Scene& scene) {
  // Keys take the place of the one value, which is not written beside them.
  if (some(0.1)) {
    scene.gravity_keys = path(scene.gravity, 10, scene.time.frame);
    scene.gravity = Scene{}.gravity;
  }
  if (some(0.1)) {
    scene.wind.velocity_keys = path(scene.wind.velocity, 5, scene.time.frame);
    scene.wind.velocity = {};
  }
  scene.solver.iterate_springs = some(0.1);
  scene.solver.full_first_kick = some(0.1);
  for (Cloth& c : scene.cloths) {
    if (some(0.15)) c.velocity = draw_.vector(draw_.chance(0.9) ? draw_.decades(0.01, 30) : 1000);
    if (some(0.15)) c.spin = draw_.vector(draw_.chance(0.9) ? draw_.decades(0.01, 30) : 1000);
    if (some(0.2)) c.level_diagonals = LevelDiagonals::one;
    for (Pin& pin : c.pins) {
      if (some(0.1)) pin.rotate = rotation(c.grid.origin, extent_of(c.grid).size, scene.time.frame);
      if (!scene.colliders.empty() && some(0.1))
        pin.follow = draw_.between(0, int(scene.colliders.size()) - 1);
    }
  }
  for (Collider& c : scene.colliders)
    if (some(0.2)) {
      const double size = draw_.chance(0.5) ? 0 : extent(scene.cloths[0]).size;
      c.rotate = rotation(place_of(c.shape), size, scene.time.frame);
    }
}

Cloth Parts::cloth(const Solver& solver, const Time& time) {
  Cloth c;
  c.grid = grid();
  masses(c);
  c.stiffness = {draw_.chance(0.9) ? draw_.decades(10, 1e4) : stiffness(), stiffness(),
                 stiffness()};
  if (some(0.2)) c.level = draw_.between(1, std::min(8, std::max(c.grid.nx, c.grid.ny) - 1));
  if (some(0.15)) c.stiffness_gradient = draw_.of({1.0, draw_.uniform(0, 1)});
  if (solver.method == Method::spring_friction || some(0.1))
    for (double* d :
         {&c.spring_damping.structural, &c.spring_damping.shear, &c.spring_damping.bend})
      *d = draw_.chance(0.7) ? draw_.decades(1e-4, 1) : draw_.of({0.0, 1e-310, 1e6});
  if (some(0.2)) c.positional_k = draw_.uniform(0, 0.5);
  if (some(0.4)) {
    const double most = time.substeps > 0 ? time.substeps / time.frame : kFarthest;
    c.drag = std::min(draw_.chance(0.9) ? draw_.decades(0.01, 20) : kFarthest, most);
  }
  if (some(0.25)) c.bending = draw_.chance(0.9) ? draw_.decades(1e-7, 0.1) : stiffness() * 1e-3;
  if (some(0.2)) make_membrane(c, solver);
  limits(c);
  c.cuts = cuts(c.grid);
  c.self_collision = self_collision(c.grid);
  c.pins = grid_pins(c.grid, time);
  return c;
}

// A membrane in place of springs, where the cloth can have one.
void Parts::make_membrane(Cloth& c, const Solver& solver) {
  const Vec3 &u = c.grid.u, &v = c.grid.v;
  const double uu = dot(u, u), vv = dot(v, v), uv = dot(u, v);
  if (solver.method == Method::positional || c.level > 0 || uv * uv > 1e-13 * uu * vv) return;
  c.stiffness = Cloth().stiffness;
  c.spring_damping = {};
  Membrane& m = c.membrane;
  m.warp = draw_.decades(1, 1e4);
  m.weft = m.warp * draw_.decades(0.2, 5);
  m.coupling = draw_.uniform(-0.95, 0.95) * std::sqrt(m.warp * m.weft);
  m.shear = std::min(m.warp, m.weft) * draw_.decades(0.01, 0.95);
  if (some(0.4)) m.damping = draw_.chance(0.9) ? draw_.decades(1e-7, 1e-3) : 1;
  if (some(0.3)) c.bending.weft *= draw_.decades(0.1, 10);
}

Cloth Parts::layer(const Cloth& below) {
  Cloth c = below;
  c.pins.clear();
  const double far = std::max(c.self_collision.thickness, 1e-3 * spacing_) * draw_.decades(0.3, 5);
  const Vec3 up = draw_.chance(0.6) ? Vec3{0, far, 0} : draw_.vector(far);
  c.grid.origin = plus(plus(c.grid.origin, up), draw_.vector(spacing_));
  return c;
}

// Any that is not of a file, by what its values are to it.
Shape Parts::shape(const Vec3& at, double size) {
  const std::vector<Shape> all = shapes_of_size(size);
  Shape shape = all[std::size_t(draw_.between(0, int(all.size()) - 1))];
  const auto length = [&] { return std::clamp(size * draw_.decades(0.02, 1), 1e-6, kFarthest); };
  for_each_value(shape, [&](const char*, auto& value, ShapeValue is) {
    if constexpr (std::is_same_v<decltype(value), Vec3&>) {
      if (is == ShapeValue::place) value = at;
      if (is == ShapeValue::point) value = plus(at, draw_.vector(size));
      if (is == ShapeValue::direction && draw_.chance(0.3)) value = draw_.vector(1);
      if (is == ShapeValue::angles)
        value = draw_.chance(0.5) ? draw_.vector(draw_.of({90.0, 360.0, 3600.0})) : Vec3{};
      if (is == ShapeValue::length)
        for (double& one : value) one = length();
    } else if (is == ShapeValue::rounding) {
      const double most = std::visit([](const auto& s) { return s.half_thickness(); }, shape);
      value = draw_.chance(0.5) ? most * draw_.uniform(0, 1) : 0;
    } else {
      value = length();
    }
  });
  return shape;
}

Friction Parts::friction() {
  Friction f;
  if (draw_.chance(0.4)) return f;
  if (draw_.chance(0.2)) {
    const double course = draw_.uniform(0, 1);
    return {FrictionModel::course, course, course};
  }
  f.statik = draw_.chance(0.9) ? draw_.uniform(0, 1.5) : 10;
  f.dynamic = draw_.chance(0.6) ? f.statik : f.statik * draw_.uniform(0, 1);
  if (draw_.chance(0.2)) {
    f.damping = draw_.decades(1e-2, 1e4);
    f.bias = draw_.decades(1e-4, 10);
  }
  return f;
}

Collider Parts::collider(const Cloth& cloth, const Time& time) {
  const Extent of = extent(cloth);
  const double size = of.size;
  Vec3 at = plus(of.middle, draw_.vector(size * draw_.decades(0.02, 0.7)));
  if (draw_.chance(0.5)) at[1] = std::max(-kFarthest, of.corner[1] - size * draw_.uniform(0, 0.6));
  Collider c;
  c.shape = shape(at, size);
  c.friction = friction();
  if (some(0.4)) c.offset = std::min(1.0, spacing_ * draw_.decades(1e-3, 2));
  if (some(0.25)) c.keys = path(at, size, time.frame);
  c.cuts = some(0.1);
  return c;
}

}  // namespace fuzz
