// Sheets that pass through each other (untangle.h).
#include "physics/contact/self/untangle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "physics/contact/colliders/shapes.h"
#include "physics/model/lattice/stages.h"
#include "physics/model/path.h"
#include "physics/step/keeper.h"
#include "weft/vec3.h"

namespace weft::physics {
namespace {

constexpr int kRowsAFrame = 8;   // that the line where sheets meet moves by
constexpr int kMostFrames = 90;  // what has not come apart by then stays as it is
constexpr double kCalm = 4e-3;   // s, until velocities within sheets that cross are a third
constexpr int kFold =
    4;  // columns, rows or edges: what is nearer on a sheet crosses in a fold of it
constexpr double kOnGrid = 1e-3;      // spacings that a pin may start off the grid of a flat sheet
constexpr double kBeyond = 0.5;       // thicknesses that an end goes beyond the triangle
constexpr double kMostOfEdge = 0.25;  // but no more than this part of its edge
// Rings about what moves that come along, and the part that each goes of the way of the one within.
constexpr int kRings = 3;
constexpr double kAlong = 0.7;

// Whether all of a sheet starts on its grid, but for the jitter.
bool starts_flat(const Cloth& cloth) {
  const Grid& g = cloth.grid;
  return std::all_of(cloth.pins.begin(), cloth.pins.end(), [&](const Pin& p) {
    if (!p.moves()) return true;
    const Vec3 off = minus(pin_alone_at(cloth, p, 0), place_on(g, p.i, p.j));
    return length(off) < kOnGrid * std::min(spacing_u(g), spacing_v(g));
  });
}

// m², of a mesh whose vertices lie there.
double area_of(const SurfaceMesh& mesh, const std::vector<Vec3>& x) {
  double area = 0;
  for (const auto& t : mesh.all()) {
    const Vec3 n = normal_of(x[std::size_t(t[0])], x[std::size_t(t[1])], x[std::size_t(t[2])]);
    area += 0.5 * length(n);
  }
  return area;
}

// Whether flat sheet a lies on one side of flat sheet b's plane.
bool on_one_side(const Grid& a, const Grid& b) {
  const Vec3 normal = cross(b.u, b.v);
  const double margin = (a.jitter + b.jitter) * length(normal);
  bool above = true, below = true;
  for (const Vec3& corner :
       {a.origin, plus(a.origin, a.u), plus(a.origin, a.v), plus(a.origin, plus(a.u, a.v))}) {
    const double height = dot(normal, minus(corner, b.origin));
    above &= height > margin;
    below &= height < -margin;
  }
  return above || below;
}

}  // namespace

Untangle::Untangle(const Scene& scene, const std::vector<ClothModel*>& cloths) {
  std::size_t count = 0;
  for (std::size_t c = 0; c < cloths.size(); ++c) {
    const SelfCollision& self = scene.cloths[c].self_collision;
    if (self.mode == SelfCollisionMode::off) continue;
    const Cloth& cloth = scene.cloths[c];
    const auto particles = std::size_t(cloths[c]->particles().count());
    Sheet sheet{cloths[c], self.thickness, 0, 0, {}, count, false};
    if (const LatticeParts* const grid = cloths[c]->lattice()) {
      sheet.area = spacing_u(cloth.grid) * spacing_v(cloth.grid);
      sheet.columns = grid->lattice.columns;
    } else {
      sheet.rest = placed_vertices(cloth.mesh);
      sheet.area = area_of(cloths[c]->surface(), sheet.rest) / double(particles);
    }
    sheets_.push_back(std::move(sheet));
    count += particles;
  }
  passing_.resize(count);
  open_.resize(count);
  opened_.resize(count);
  due_ = may_cross(scene);
}

const Untangle::Sheet& Untangle::sheet_of(std::int32_t particle) const {
  auto sheet =
      std::upper_bound(sheets_.begin(), sheets_.end(), std::size_t(particle),
                       [](std::size_t number, const Sheet& s) { return number < s.first; });
  return *--sheet;
}

double Untangle::inverse_mass(std::int32_t particle) const {
  const Sheet& s = sheet_of(particle);
  const Particles& p = s.cloth->particles();
  return double(p.inverse_mass[p.lane(int(std::size_t(particle) - s.first))]);
}

// A flat sheet does not cross itself, nor one that lies on one side of it. Meshes are looked at.
bool Untangle::may_cross(const Scene& scene) const {
  std::vector<const Cloth*> cloths;
  for (const Cloth& c : scene.cloths)
    if (c.self_collision.mode != SelfCollisionMode::off) cloths.push_back(&c);
  for (const Cloth* a : cloths) {
    if (a->mesh.given() || !starts_flat(*a)) return true;
    for (const Cloth* b : cloths)
      if (a < b && !on_one_side(a->grid, b->grid) && !on_one_side(b->grid, a->grid)) return true;
  }
  return false;
}

bool Untangle::passes(std::int32_t particle, std::int32_t line) const {
  for (std::size_t n = first_end(particle); n < ends_.size() && ends_[n].particle == particle; ++n)
    if (ends_[n].line == line) return ends_[n].passes;
  return false;
}

std::size_t Untangle::crossings() {
  x_.clear();
  faces_.clear();
  sewn_.clear();
  for (const Sheet& s : sheets_) {
    add_surface(*s.cloth, x_, faces_);
    add_sewn(*s.cloth, sewn_);
  }
  std::erase_if(faces_, [&](const Face& f) {
    return std::any_of(f.begin(), f.end(), [&](auto c) { return open_[std::size_t(c)] != 0; });
  });
  edges_ = edges_of(faces_);
  crossings_ = find_crossings(x_, faces_, edges_, sewn_);
  return crossings_.size();
}

bool Untangle::look_at_seams() {
  std::fill(opened_.begin(), opened_.end(), std::uint8_t{0});
  for (const Sheet& s : sheets_)
    s.cloth->mark_open_seams(
        0.5 * s.thickness,
        std::span(opened_).subspan(s.first, std::size_t(s.cloth->particles().count())));
  if (opened_ == open_) return false;
  std::swap(opened_, open_);
  clear_passing();
  look();
  return true;
}

void Untangle::keep(Keeper& keeper) {
  keeper(due_);
  keeper(since_);
  keeper(came_apart_);
  for (auto* marks : {&passing_, &open_, &opened_}) keeper(*marks);
  for (Sheet& s : sheets_) keeper(s.crosses);
}

void Untangle::clear_passing() {
  std::copy(open_.begin(), open_.end(), passing_.begin());
}

void Untangle::pull_apart() {
  clear_passing();
  since_ = crossings() > 0 ? since_ + 1 : 0;
  due_ = since_ > 0 && since_ <= kMostFrames;
  if (!due_) came_apart_ = false;
  if (!due_) return;
  mark_what_crosses();
  // Where all crosses all, which takes long to tell, one a frame.
  const int rows = crossings_.size() > x_.size() ? 1 : kRowsAFrame;
  for (int row = 0; row < rows && !crossings_.empty(); ++row) {
    choose_parts();
    move_ends();
    crossings_ = find_crossings(x_, faces_, edges_, sewn_);
  }
  // What has come apart may settle for a frame; where it crosses again, contact keeps it apart at once.
  if (crossings_.empty() && std::exchange(came_apart_, true)) clear_passing();
  put_back();
}

// Sheets that cross another, or themselves.
void Untangle::mark_what_crosses() {
  for (Sheet& s : sheets_) s.crosses = false;
  for (const Crossing& c : crossings_)
    for (const std::int32_t particle : {c.edge[0], faces_[std::size_t(c.face)][0]})
      sheets_[std::size_t(&sheet_of(particle) - sheets_.data())].crosses = true;
}

void Untangle::calm(double seconds) {
  const double keep = std::exp(-seconds / kCalm);
  for (const Sheet& s : sheets_) {
    Particles& l = s.cloth->particles();
    if (!s.crosses) continue;
    Vec3 momentum{};
    double mass = 0;
    const auto for_each_free = [&](const auto& visit) {
      for (int j = 0; j < l.rows; ++j)
        for (int i = 0; i < l.count(j); ++i)
          if (l.w(j, i) > 0) visit(j, i, 1 / double(l.w(j, i)));
    };
    for_each_free([&](int j, int i, double m) {
      mass += m;
      for (int k = 0; k < 3; ++k) momentum[std::size_t(k)] += m * double(l.v.at(k, j, i));
    });
    for_each_free([&](int j, int i, double) {
      for (int k = 0; k < 3; ++k) {
        const double mean = momentum[std::size_t(k)] / mass;
        l.v.at(k, j, i) = float(mean + keep * (double(l.v.at(k, j, i)) - mean));
      }
    });
  }
}

// Whether two are that near on one sheet that the sides of what crosses there tell little.
bool Untangle::in_a_fold(std::int32_t a, std::int32_t b) const {
  const Sheet& s = sheet_of(a);
  if (&s != &sheet_of(b)) return false;
  const int n = a - int(s.first), m = b - int(s.first), columns = s.columns;
  if (!s.rest.empty()) {
    const Vec3 apart = minus(s.rest[std::size_t(n)], s.rest[std::size_t(m)]);
    return dot(apart, apart) <= kFold * kFold * s.area;
  }
  return std::abs(n % columns - m % columns) <= kFold &&
         std::abs(n / columns - m / columns) <= kFold;
}

// From a particle to the middle of its neighbours.
Vec3 Untangle::to_neighbours(std::int32_t particle) const {
  const std::size_t begin = first_[std::size_t(particle)], end = first_[std::size_t(particle) + 1];
  if (begin == end || !(inverse_mass(particle) > 0)) return {};
  Vec3 sum{};
  for (std::size_t n = begin; n < end; ++n) sum = plus(sum, at(neighbours_[n]));
  return minus(times(sum, 1 / double(end - begin)), at(particle));
}

// Each moves by the mean of what the edges that it is an end of, and the triangles that it is a corner
// of, ask for. What lies about comes along.
void Untangle::move_ends() {
  Moves m{std::vector<Vec3>(x_.size(), Vec3{}), std::vector<int>(x_.size(), 0)};
  for (std::size_t k = 0; k < crossings_.size(); ++k) {
    const auto [a, b] = crossings_[k].edge;
    const Face& f = faces_[std::size_t(crossings_[k].face)];
    if (in_a_fold(a, f[0])) {
      for (const std::int32_t n : {a, b, f[0], f[1], f[2]}) m.ask(n, to_neighbours(n));
      continue;
    }
    const bool passes_a = passes(a, line_[k]), passes_b = passes(b, line_[k]);
    if (passes_a && !passes_b) take_through(a, b, f, m);
    if (passes_b && !passes_a) take_through(b, a, f, m);
  }
  for (std::size_t n = 0; n < x_.size(); ++n)
    if (m.asked[n] > 0) m.way[n] = times(m.way[n], 1.0 / m.asked[n]);
  for (int ring = 0; ring < kRings; ++ring) take_along(m);
  for (std::size_t n = 0; n < x_.size(); ++n) x_[n] = plus(x_[n], m.way[n]);
}

// An edge's end goes towards the other, as far as the triangle between them and then some: half the way
// itself, and half the triangle comes to meet it, but by no more than a part of its size.
void Untangle::take_through(std::int32_t end, std::int32_t other, const Face& f, Moves& m) const {
  const Vec3 normal = normal_of(at(f[0]), at(f[1]), at(f[2])), edge = minus(at(other), at(end));
  const double area = length(normal);
  // Where the edge passes, by its length and by the triangle's corners.
  const double along = dot(normal, minus(at(f[0]), at(end))) / dot(normal, edge);
  if (!(area > 0) || !(along > 0 && along < 1)) return;
  const Vec3 place = plus(at(end), times(edge, along));
  std::array<double, 3> share{};
  double sum_of_squares = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    if (!(inverse_mass(f[c]) > 0)) continue;
    const Vec3 across = normal_of(place, at(f[(c + 1) % 3]), at(f[(c + 2) % 3]));
    share[c] = std::max(0.0, dot(normal, across)) / (area * area);
    sum_of_squares += share[c] * share[c];
  }
  const Vec3 direction = times(normal, (dot(normal, edge) > 0 ? 1 : -1) / area);
  const double beyond = std::min(kBeyond * sheet_of(end).thickness, kMostOfEdge * length(edge));
  const double far = along * dot(direction, edge) + beyond;
  const bool held = !(inverse_mass(end) > 0), triangle_held = !(sum_of_squares > 0);
  const double most = kMostOfEdge * std::sqrt(sheet_of(f[0]).area);
  const double theirs = triangle_held ? 0 : held ? far : std::min(0.5 * far, most);
  for (std::size_t c = 0; c < 3; ++c)
    if (share[c] > 0) m.ask(f[c], times(direction, -theirs * share[c] / sum_of_squares));
  if (!held) m.ask(end, times(direction, far - theirs));
}

// What is next to what moves goes a part of the way with it.
void Untangle::take_along(Moves& m) const {
  std::vector<int> count(x_.size(), 0);
  for (const auto& [a, b] : edges_)
    for (const auto& [from, to] : {std::pair(a, b), std::pair(b, a)}) {
      const auto n = std::size_t(from), next = std::size_t(to);
      if (m.asked[n] == 0 || m.asked[next] > 0 || !(inverse_mass(to) > 0)) continue;
      m.way[next] = plus(m.way[next], m.way[n]);
      ++count[next];
    }
  for (std::size_t n = 0; n < x_.size(); ++n)
    if (count[n] > 0) {
      m.way[n] = times(m.way[n], kAlong / count[n]);
      m.asked[n] = 1;
    }
}

void Untangle::put_back() {
  for (const Sheet& s : sheets_) {
    Particles& p = s.cloth->particles();
    std::size_t n = s.first;
    p.for_each([&](int j, int i) {
      for (int k = 0; k < 3; ++k) p.x.at(k, j, i) = coordinate(x_[n][std::size_t(k)]);
      ++n;
    });
  }
}

}  // namespace weft::physics
