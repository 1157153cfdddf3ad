#include "physics/model/mesh/mesh_tearing.h"

#include <algorithm>
#include <numeric>

#include "physics/model/mesh/mesh_tear_boundary.h"

namespace weft::physics {
namespace {

void keep_once(std::vector<int>& numbers) {
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

}  // namespace

MeshTearing::MeshTearing(const Parts& parts)
    : parts_(parts),
      membrane_(parts.cloth.membrane.given()),
      whole_(parts.triangles),
      sides_(parts.edges.ends.size()),
      edge_of_(3 * parts.mesh.triangles.size()),
      around_(parts.mesh.vertices.size()),
      row_(sides_.size()),
      rows_(parts.order.counts.size()),
      holds_(sides_.size(), 1),
      followed_edges_(holds_),
      died_(rows_.size()),
      followed_(died_),
      gone_(whole_.size()),
      boundary_(parts.cloth.tears == Tears::split ? std::make_unique<MeshTearBoundary>()
                                                  : nullptr) {
  for (std::size_t t = 0; t < whole_.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& corners = parts.mesh.triangles[t];
      const int edge = edge_between(corners[k], corners[(k + 1) % 3]);
      auto& [first, second] = sides_[std::size_t(edge)];
      (first.triangle < 0 ? first : second) = {int(t), k};
      edge_of_[3 * t + k] = edge;
      around_[std::size_t(corners[k])].push_back(int(t));
    }
  find_rows();
  parts_.surface.whole = parts_.surface.triangles;
  parts_.surface.gone.assign(whole_.size(), 0);
  // Frames allocate nothing unless much tears at once.
  for (std::vector<int>* list : {&lost_, &touched_, &about_}) list->reserve(3 * whole_.size());
  list_triangles();
}

MeshTearing::~MeshTearing() = default;

void MeshTearing::find_rows() {
  const std::vector<int>& rows = parts_.order.rows;
  const auto first_of = [&](int triangle) {
    int first = int(rows_.size());
    for (const int c : whole_[std::size_t(triangle)].corner)
      if (c >= 0) first = std::min(first, rows[std::size_t(c)]);
    return first;
  };
  for (std::size_t e = 0; e < sides_.size(); ++e) {
    int low = int(rows_.size()), high = 0;
    for_each_side(int(e), [&](const Side& side) {
      low = std::min(low, first_of(side.triangle));
      for (const int c : parts_.mesh.triangles[std::size_t(side.triangle)])
        high = std::max(high, rows[std::size_t(c)]);
    });
    row_[e] = low;
    rows_[std::size_t(low)].push_back(int(e));
    reach_ = std::max(reach_, high - low);
  }
}

// -1: none.
int MeshTearing::edge_between(int a, int b) const {
  const auto& ends = parts_.edges.ends;
  const Joined edge{std::min(a, b), std::max(a, b)};
  const auto at = std::lower_bound(ends.begin(), ends.end(), edge);
  return at != ends.end() && *at == edge ? int(at - ends.begin()) : -1;
}

void MeshTearing::end(int edge) {
  if (!holds_[std::size_t(edge)]) return;
  ++died_[std::size_t(row_[std::size_t(edge)])];
  set(edge, false);
}

void MeshTearing::set(int edge, bool holds) {
  holds_[std::size_t(edge)] = holds;
  for_each_side(edge, [&](const Side& side) { stretch_as_now(side); });
  for (TornParts* parts : told_) parts->set_edge(edge, holds);
}

void MeshTearing::stretch_as_now(const Side& side) {
  const auto t = std::size_t(side.triangle);
  RestTriangle& r = parts_.triangles[t];
  r.half[side.k] = holds_[std::size_t(edge_of(side.triangle, side.k))];
  bool all = true;
  for (std::size_t k = 0; k < 3; ++k) all = all && holds_[std::size_t(edge_of(side.triangle, k))];
  r.area = all ? whole_[t].area : 0;
}

// What ends at a pinch, or for want of a triangle, may be followed by more.
bool MeshTearing::update() {
  if (died_ == followed_) return false;
  touched_.clear();
  while (follow()) {
    if (membrane_) end_unheld();
    end_pinches();
    touched_.insert(touched_.end(), lost_.begin(), lost_.end());
  }
  torn_ = std::accumulate(died_.begin(), died_.end(), std::int64_t(0));
  bend_about();
  ++version_;
  list_triangles();
  return true;
}

// Marks edges that have ended since the last time, in triangles that it lists; false: there are none.
bool MeshTearing::follow() {
  lost_.clear();
  if (died_ == followed_) return false;
  followed_ = died_;
  for (std::size_t e = 0; e < holds_.size(); ++e) {
    if (holds_[e] == followed_edges_[e]) continue;
    followed_edges_[e] = holds_[e];
    for_each_side(int(e), [&](const Side& side) {
      gone_[std::size_t(side.triangle)] |= std::uint8_t(1 << side.k);
      lost_.push_back(side.triangle);
    });
  }
  keep_once(lost_);
  return true;
}

void MeshTearing::end_unheld() {
  for (const int t : lost_)
    for (std::size_t k = 0; k < 3; ++k) {
      bool held = false;
      for_each_side(edge_of(t, k),
                    [&](const Side& side) { held |= !gone_[std::size_t(side.triangle)]; });
      if (!held) end(edge_of(t, k));
    }
}

void MeshTearing::end_pinches() {
  about_.clear();
  for (const int t : lost_)
    for (const int v : parts_.mesh.triangles[std::size_t(t)]) about_.push_back(v);
  keep_once(about_);
  for (const int v : about_) end_pinch(v);
}

void MeshTearing::end_pinch(int vertex) {
  const auto corner = [&](int t, std::size_t k) {
    return parts_.mesh.triangles[std::size_t(t)][k % 3];
  };
  // The side of a triangle that lies across from the vertex.
  const auto across = [&](int t) {
    std::size_t k = 0;
    while (corner(t, k + 2) != vertex) ++k;
    return k;
  };
  pieces_.clear();
  for (const int t : around(vertex)) {
    const std::size_t k = across(t);
    pieces_.find(corner(t, k)), pieces_.find(corner(t, k + 1));
    if (holds_[std::size_t(edge_of(t, k))]) pieces_.join(corner(t, k), corner(t, k + 1));
  }
  for (const int t : around(vertex))
    if (!gone_[std::size_t(t)])
      pieces_.area(pieces_.find(corner(t, across(t)))) += whole_[std::size_t(t)].area;
  const int kept = pieces_.largest();
  for (const int t : around(vertex)) {
    const std::size_t k = across(t);
    for (const auto& [at, edge] : {std::pair(k, k + 2), {k + 1, k + 1}}) {
      const int piece = pieces_.find(corner(t, at));
      if (piece != kept && pieces_.area(piece) > 0) end(edge_of(t, edge));
    }
  }
}

// Hinges are between triangles that are left.
void MeshTearing::bend_as_now(int triangle) {
  const RestTriangle& w = whole_[std::size_t(triangle)];
  RestTriangle& r = parts_.triangles[std::size_t(triangle)];
  double holds[3];
  for (std::size_t k = 0; k < 3; ++k) {
    bool all = true;
    for_each_side(edge_of(triangle, k),
                  [&](const Side& side) { all = all && !gone_[std::size_t(side.triangle)]; });
    holds[k] = all;
    r.away[k] = holds[k] * w.away[k], r.away_at[k] = holds[k] * w.away_at[k];
    r.own[k] = holds[k] * w.own[k], r.own_at[k] = holds[k] * w.own_at[k];
    r.bow[k] = holds[k] * w.bow[k];
  }
  for (std::size_t m = 0; m < 6; ++m)
    r.moment[m] = holds[m % 3] * holds[m < 3 ? m : (m + 1) % 3] * w.moment[m];
  for (TornParts* parts : told_) parts->set_triangle(triangle);
}

// Of the triangles that were touched, and beside them.
void MeshTearing::bend_about() {
  about_.clear();
  for (const int t : touched_)
    for (std::size_t k = 0; k < 3; ++k)
      for_each_side(edge_of(t, k), [&](const Side& side) { about_.push_back(side.triangle); });
  keep_once(about_);
  for (const int t : about_) bend_as_now(t);
}

void MeshTearing::list_triangles() {
  SurfaceMesh& surface = parts_.surface;
  surface.version = version_;
  surface.gone = gone_;
  surface.triangles.clear();
  drawn_.clear();
  uv_.clear();
  for (std::size_t t = 0; t < gone_.size(); ++t) {
    if (gone_[t]) continue;
    surface.triangles.push_back(surface.whole[t]);
    drawn_.push_back(parts_.drawn.triangles[t]);
    if (!parts_.drawn.uv.empty()) uv_.push_back(parts_.drawn.uv[t]);
  }
}

void MeshTearing::go_back() {
  for (std::size_t e = 0; e < remembered_.size(); ++e)
    if (holds_[e] != remembered_[e]) set(int(e), remembered_[e]);
  died_ = followed_;
}

std::vector<Joined> MeshTearing::torn_list() const {
  std::vector<Joined> list;
  for (std::size_t e = 0; e < holds_.size(); ++e)
    if (!holds_[e]) list.push_back(parts_.edges.ends[e]);
  return list;
}

void MeshTearing::set_torn(const std::vector<Joined>& torn) {
  touched_.clear();
  for (std::size_t e = 0; e < holds_.size(); ++e)
    if (!holds_[e]) set(int(e), true);
  for (std::size_t t = 0; t < gone_.size(); ++t)
    if (gone_[t]) touched_.push_back(int(t));
  std::fill(gone_.begin(), gone_.end(), std::uint8_t(0));
  std::fill(died_.begin(), died_.end(), 0);
  followed_ = died_;
  followed_edges_ = holds_;
  torn_ = 0;
  bend_about();
  for (const auto& [a, b] : torn)
    if (const int edge = edge_between(a, b); edge >= 0) end(edge);
  if (update()) return;
  ++version_;
  list_triangles();
}

std::int64_t MeshTearing::end_all(const std::vector<Joined>& constraints) {
  const std::int64_t before = torn_;
  for (const auto& [a, b] : constraints)
    if (const int edge = edge_between(a, b); edge >= 0) end(edge);
  update();
  return torn_ - before;
}

TornSurface MeshTearing::surface() {
  if (torn_ == 0 || !boundary_) return {drawn_, {}, {}, {}, uv_};
  boundary_->update(*this);
  return {drawn_, boundary_->points(), boundary_->owners(), boundary_->triangles(), uv_};
}

void MeshTearing::tell(TornParts& parts) {
  told_.push_back(&parts);
  for (std::size_t e = 0; e < holds_.size(); ++e)
    if (!holds_[e]) parts.set_edge(int(e), false);
  for (std::size_t t = 0; t < gone_.size(); ++t)
    if (gone_[t]) parts.set_triangle(int(t));
}

std::size_t MeshTearing::bytes() const {
  const std::size_t edges = sides_.size(), triangles = whole_.size();
  return triangles * (sizeof(RestTriangle) + 2 * sizeof(drawn_[0]) + 15 * sizeof(int) + 2) +
         uv_.capacity() * sizeof(uv_[0]) + edges * (sizeof(sides_[0]) + 2 * sizeof(int) + 3) +
         (boundary_ ? boundary_->bytes() : 0);
}

}  // namespace weft::physics
