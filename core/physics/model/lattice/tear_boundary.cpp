// The tear boundary of a torn cloth (tear_boundary.h).
#include "physics/model/lattice/tear_boundary.h"

#include "physics/model/lattice/cuts.h"

namespace weft::physics {
namespace {

// Whether the constraint between neighbours (i, j) and (i + di, j + dj) is there.
bool joined(const LatticeTearing& t, int i, int j, int di, int dj) {
  const int a = std::min(i, i + di), b = std::min(j, j + dj);
  return a >= 0 && b >= 0 && std::max(i, i + di) < t.columns() && std::max(j, j + dj) < t.rows() &&
         t.alive(di != 0, dj != 0, a, b);
}

}  // namespace

TearBoundary::TearBoundary(const Cloth& cloth) {
  for (const auto& [di, dj] : {std::pair(1, 0), {0, 1}, {-1, 1}})
    for_each_cut(cloth.cuts, cloth.grid, di, dj,
                 [&, i_step = di, j_step = dj](int i, int j, double share) {
                   shares_[{i, j, i + i_step, j + j_step}] = float(share);
                 });
}

float TearBoundary::share(Site from, Site to) const {
  if (const auto known = shares_.find({from.i, from.j, to.i, to.j}); known != shares_.end())
    return known->second;
  const auto back = shares_.find({to.i, to.j, from.i, from.j});
  return back != shares_.end() ? 1 - back->second : 0.5f;
}

void TearBoundary::update(const LatticeTearing& tearing, const Lattice& lattice) {
  if (version_ != tearing.version()) rebuild(tearing);
  version_ = tearing.version();
  const auto x = lattice.x.component(0), y = lattice.x.component(1), z = lattice.x.component(2);
  for (std::size_t n = 0; n < points_.size(); ++n) {
    const Point& p = points_[n];
    std::array<float, 3> at{x[p.particle], y[p.particle], z[p.particle]};
    for (const Step& s : p.steps) {
      at[0] += s.weight * (x[s.to] - x[s.from]);
      at[1] += s.weight * (y[s.to] - y[s.from]);
      at[2] += s.weight * (z[s.to] - z[s.from]);
    }
    places_[n] = at;
  }
}

void TearBoundary::rebuild(const LatticeTearing& t) {
  points_.clear();
  owners_.clear();
  triangles_.clear();
  for (int j = 0; j + 1 < t.rows(); ++j)
    for (int i = 0; i + 1 < t.columns(); ++i) {
      const unsigned gone = t.gone(i, j);
      if (gone & 7) add_triangle(t, {Site{i, j}, {i + 1, j}, {i, j + 1}}, gone & 7);
      if (gone >> 3) add_triangle(t, {Site{i + 1, j}, {i + 1, j + 1}, {i, j + 1}}, gone >> 3);
    }
  places_.resize(points_.size());
}

void TearBoundary::add_triangle(const LatticeTearing& t, const std::array<Site, 3>& corner,
                                unsigned gone) {
  const auto far = [](const Site& p, const Site& q, float share) {
    return std::pair(share * float(q.i - p.i), share * float(q.j - p.j));
  };
  const auto own = [&](const Site& p) { return point(t, p, 0, 0); };
  // Where the tear crosses the edge to q, as seen from p.
  const auto end = [&](const Site& p, const Site& q) {
    const auto [along, down] = far(p, q, share(p, q));
    return point(t, p, along, down);
  };
  const auto middle = [&](const Site& a, const Site& b, const Site& c) {
    const auto [along_b, down_b] = far(a, b, 1 / 3.0f);
    const auto [along_c, down_c] = far(a, c, 1 / 3.0f);
    return point(t, a, along_b + along_c, down_b + down_c);
  };
  share_torn_triangle(corner, gone, own, end, middle,
                      [&](const std::array<TornPoint, 3>& points) { add(points); });
}

TornPoint TearBoundary::point(const LatticeTearing& t, Site p, float along, float down) {
  const auto number = [&](int i, int j) { return static_cast<std::uint32_t>(j * t.stride() + i); };
  Point made{number(p.i, p.j), {}};
  for (const int axis : {0, 1}) {
    const float weight = axis == 0 ? along : down;
    if (weight == 0) continue;
    const int di = axis == 0, dj = axis == 1, side = weight > 0 ? 1 : -1;
    // The step itself, or its continuation from behind, or one beside it.
    bool found = false;
    for (const auto& [beside, way] :
         {std::pair(0, side), {0, -side}, {1, side}, {-1, side}, {1, -side}, {-1, -side}}) {
      const int i = p.i + beside * dj, j = p.j + beside * di;
      if (beside != 0 && !joined(t, p.i, p.j, beside * dj, beside * di)) continue;
      if (!joined(t, i, j, way * di, way * dj)) continue;
      const std::uint32_t here = number(i, j), there = number(i + way * di, j + way * dj);
      made.steps[axis] = {here, there, way == side ? std::abs(weight) : -std::abs(weight)};
      found = true;
      break;
    }
    if (!found) return std::nullopt;
  }
  points_.push_back(made);
  owners_.push_back(made.particle);
  return static_cast<std::uint32_t>(points_.size() - 1);
}

// (In braces the corners are made in their order; the arguments of a call are not.)
void TearBoundary::add(const std::array<TornPoint, 3>& c) {
  if (c[0] && c[1] && c[2]) triangles_.push_back({*c[0], *c[1], *c[2]});
}

std::size_t TearBoundary::bytes() const {
  return points_.capacity() * sizeof(Point) + owners_.capacity() * 4 +
         places_.capacity() * sizeof(places_[0]) + triangles_.capacity() * sizeof(triangles_[0]);
}

}  // namespace weft::physics
