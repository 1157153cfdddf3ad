#include <algorithm>

#include "random_mesh.h"
#include "random_parts.h"
#include "weft/shape.h"

namespace fuzz {

using namespace weft;

namespace {

// What meshes do not have goes.
void leave_out_what_is_of_grids(Cloth& c) {
  const Cloth plain;
  c.grid = plain.grid;
  c.particle_mass = plain.particle_mass;
  c.masses.clear();
  c.lumping = plain.lumping;
  c.stiffness = {c.stiffness.structural, plain.stiffness.shear, plain.stiffness.bend};
  c.spring_damping = {c.spring_damping.structural, 0, 0};
  c.level = plain.level;
  c.stiffness_gradient = plain.stiffness_gradient;
  c.positional_k = plain.positional_k;
  if (c.strain_limit_order == StrainLimitOrder::course)
    c.strain_limit_order = plain.strain_limit_order;
  c.tear_strain = plain.tear_strain;
  c.tears = plain.tears;
  c.cuts.clear();
  c.self_collision.response = plain.self_collision.response;
}

// As it is, flat, as its texture coordinates, or bent otherwise.
void choose_rest(Cloth& c, Draw& draw, const std::string& file) {
  c.mesh.rest =
      draw.of({MeshRest::shape, MeshRest::shape, MeshRest::flat, MeshRest::uv, MeshRest::file});
  if (c.mesh.rest == MeshRest::uv && c.mesh.shape->uv.empty()) c.mesh.rest = MeshRest::flat;
  if (c.mesh.rest == MeshRest::uv) c.mesh.uv_scale = draw.decades(0.8, 1.25);
  if (c.mesh.rest != MeshRest::file) return;
  auto shape = std::make_shared<TriangleMesh>(*c.mesh.shape);
  const double curve = draw.uniform(-1, 1) / std::max(extent(c).size / c.mesh.scale, 1e-9);
  for (Vec3& p : shape->vertices) p[1] += curve * p[0] * p[0];
  c.mesh.at_rest.file = file;
  c.mesh.at_rest.shape = std::move(shape);
}

// The method and the sweep that meshes have.
void choose_method(Scene& scene, Draw& draw) {
  Solver& s = scene.solver;
  const Solver plain;
  if (s.method == Method::positional) s.method = draw.of({Method::spring, Method::compliant});
  if (s.method != Method::compliant) {
    s.sweep = plain.sweep, s.tethers = plain.tethers, s.order = plain.order;
    return;
  }
  if (s.sweep == Sweep::jacobi) s.sweep = draw.of({Sweep::line, Sweep::gauss_seidel});
  for (Cloth& c : scene.cloths)
    if (c.mesh.given() && s.tethers && c.mesh.rest == MeshRest::uv) c.mesh.rest = MeshRest::flat;
}

}  // namespace

Extent extent(const Cloth& cloth) {
  if (!cloth.mesh.given()) return extent_of(cloth.grid);
  const std::vector<Vec3> x = placed_vertices(cloth.mesh);
  Vec3 low = x[0], high = x[0];
  for (const Vec3& p : x)
    for (std::size_t k = 0; k < 3; ++k)
      low[k] = std::min(low[k], p[k]), high[k] = std::max(high[k], p[k]);
  const Vec3 sides = plus(high, low, -1);
  return {low, plus(low, sides, 0.5), std::max({sides[0], sides[1], sides[2]}),
          mean_edge(cloth.mesh)};
}

std::vector<Pin> Parts::vertex_pins(const Cloth& c, const Time& time) {
  std::vector<Pin> pins;
  const std::vector<Vec3> places = placed_vertices(c.mesh);
  for (int n = draw_.between(0, 4); n > 0; --n) {
    const int i = draw_.between(0, int(places.size()) - 1);
    if (std::any_of(pins.begin(), pins.end(), [&](const Pin& pin) { return pin.i == i; })) continue;
    pins.push_back({i, 0, {}});
    if (some(0.25)) pins.back().keys = path(places[std::size_t(i)], extent(c).size, time.frame);
  }
  return pins;
}

void Parts::gather_pins(Scene& scene) {
  for (Cloth& c : scene.cloths) {
    if (!draw_.chance(0.2)) continue;
    Pin all;
    for (const Pin& pin : c.pins)
      if (!pin.moves()) all.vertices.push_back(particle_number(c, pin));
    std::erase_if(c.pins, [](const Pin& pin) { return !pin.moves(); });
    const Extent e = extent(c);
    if (draw_.chance(0.5)) all.keys = path({}, e.size, scene.time.frame);
    if (all.vertices.empty()) {
      const Vec3 corner = plus(e.middle, draw_.vector(0.6 * e.size));
      all.box = BoxCorners{corner, plus(corner, draw_.vector(e.size))};
    }
    c.pins.push_back(std::move(all));
    // A box may hold nothing, or what is held already.
    if (c.pins.back().box && !validate(scene).empty()) c.pins.pop_back();
  }
}

// Pins hold the vertices of their particles' numbers, where there are as many.
void Parts::make_mesh(Cloth& c, const std::string& file) {
  const Grid g = c.grid;
  const auto sheet = random_sheet(draw_, g.nx, g.ny);
  if (!sheet) return;
  auto shape = std::make_shared<TriangleMesh>(*sheet);
  c.mesh.scale = some(0.3) ? draw_.decades(1e-3, 1e3) : 1;
  const double along = length(g.u), across = length(g.v), up = std::min(along, across);
  for (Vec3& p : shape->vertices)
    p = {along * p[0] / c.mesh.scale, up * p[1] / c.mesh.scale, across * p[2] / c.mesh.scale};
  for (auto& corners : shape->uv)
    for (auto& uv : corners) uv = {along * uv[0], across * uv[1]};
  c.mesh.file = file;
  c.mesh.shape = std::move(shape);
  c.mesh.translate = g.origin;
  if (draw_.chance(0.4)) c.mesh.rotate = draw_.vector(draw_.of({90.0, 360.0, 3600.0}));
  const int vertices = int(c.mesh.shape->vertices.size());
  for (Pin& pin : c.pins) pin.i = particle_number(g, pin.i, pin.j), pin.j = 0;
  std::erase_if(c.pins, [&](const Pin& pin) { return pin.i >= vertices; });
  leave_out_what_is_of_grids(c);
  choose_rest(c, draw_, "rest-" + file);
}

// A few pairs of vertices and a loose edge, unless these join two corners of a triangle.
void Parts::sew(Cloth& c) {
  const int last = int(c.mesh.shape->vertices.size()) - 1;
  for (int n = draw_.between(1, 6); n > 0; --n)
    c.seams.push_back({draw_.between(0, last), draw_.between(0, last)});
  auto shape = std::make_shared<TriangleMesh>(*c.mesh.shape);
  shape->edges.push_back({draw_.between(0, last), draw_.between(0, last)});
  c.mesh.shape = std::move(shape);
  c.sewing = draw_.chance(0.5);
  Scene alone;
  alone.cloths = {c};
  const std::vector<Fault> faults = validate(alone);
  if (std::any_of(faults.begin(), faults.end(), [](const Fault& f) {
        return f.place.starts_with("/cloths/0/sewing") || f.place.starts_with("/cloths/0/seams");
      }))
    c.seams.clear(), c.sewing = false;
}

MeshBody Parts::body(const Vec3& at, double size, const std::string& file) {
  MeshBody body;
  body.file = file;
  body.shape = random_body(draw_);
  body.scale = std::clamp(size * draw_.decades(0.02, 1), 1e-4, 1e3);
  body.translate = at;
  if (draw_.chance(0.4)) body.rotate = draw_.vector(360);
  if (body.shape) body.surface = surface_of(body);
  return body;
}

void Parts::add_meshes(Scene& scene) {
  for (std::size_t n = 0; n < scene.colliders.size(); ++n)
    if (draw_.chance(0.5)) {
      Collider& c = scene.colliders[n];
      const Vec3 at = c.keys.empty() ? place_of(c.shape) : c.keys[0].position;
      c.shape = body(at, extent(scene.cloths[0]).size, "body" + std::to_string(n) + ".obj");
      if (MeshBody& body = std::get<MeshBody>(c.shape); draw_.chance(0.4)) {
        c.animation = "motion" + std::to_string(n) + ".mdd";
        body.motion = random_motion(draw_, *body.shape, scene.time.frame);
        body.surface = surface_of(body, scene.time.frame);
      }
      if (c.offset < 1e-4 && draw_.chance(0.9))
        c.offset = std::min(1.0, spacing_ * draw_.decades(0.01, 1));
    }
  for (std::size_t n = 0; n < scene.cloths.size(); ++n)
    if (draw_.chance(0.7)) {
      make_mesh(scene.cloths[n], "cloth" + std::to_string(n) + ".obj");
      if (scene.cloths[n].mesh.given() && draw_.chance(0.3)) sew(scene.cloths[n]);
    }
  const auto is_mesh = [](const Cloth& c) { return c.mesh.given(); };
  if (std::none_of(scene.cloths.begin(), scene.cloths.end(), is_mesh)) return;
  choose_method(scene, draw_);
  for (Collider& c : scene.colliders) c.cuts = false;
}

void Parts::add_gas(Scene& scene) {
  Cloth& c = scene.cloths[std::size_t(draw_.between(0, int(scene.cloths.size()) - 1))];
  const auto shape = random_body(draw_);
  if (!shape) return;
  const Extent e = extent(c);
  c.mesh = {};
  c.mesh.file = "gas.obj";
  c.mesh.shape = shape;
  c.mesh.scale = std::clamp(0.5 * e.size, 1e-4, 1e3);
  c.mesh.translate = e.middle;
  c.seams.clear();
  c.sewing = false;
  c.pins.clear();
  leave_out_what_is_of_grids(c);
  if (draw_.chance(0.5))
    c.pressure.over = draw_.decades(1, 1e4) * (draw_.chance(0.2) ? -1 : 1);
  else
    c.pressure.inflate = draw_.decades(0.5, 3), c.pressure.ambient = draw_.decades(10, 1e6);
  if (draw_.chance(0.3))
    c.pressure.keys = {{0, draw_.uniform(0, 1)}, {draw_.decades(0.01, 1), draw_.uniform(0, 2)}};
  choose_method(scene, draw_);
  for (Collider& collider : scene.colliders) collider.cuts = false;
}

void Parts::tear_meshes(Scene& scene) {
  bool meshes = false;
  for (Cloth& c : scene.cloths) {
    if (!c.mesh.given()) continue;
    meshes = true;
    if (draw_.chance(0.3)) c.tear_strain = draw_.decades(1e-3, 10);
    if (draw_.chance(0.2)) c.tears = Tears::holes;
  }
  for (std::size_t n = 0; meshes && n < scene.colliders.size(); ++n) {
    bool& cuts = scene.colliders[n].cuts;
    cuts = draw_.chance(0.2);
    if (cuts && !validate(scene).empty()) cuts = false;
  }
}

}  // namespace fuzz
