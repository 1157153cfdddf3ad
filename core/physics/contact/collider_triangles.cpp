// Stages "collider_faces" and "stretched_faces": a collider with features smaller than the mesh as it is now
// is caught by the triangles that it would slip through between the particles (seed 000 names this failure).
// How deep a triangle may lie is said by AllowedDepth. Where the mesh at rest resolves the collider, rows are
// looked at closely only while a triangle of theirs is stretched (the second of the two). What a tear has
// ended is no triangle.
//
// The point p = Σ b_k x_k of a triangle deepest in the collider is lifted out by `depth` along the
// normal there, each corner by its share:  x_k += w_k b_k / (Σ w b²) n depth.  It rubs like a
// particle: p's velocity into the surface is lost, friction shortens the rest. Beside a held corner the
// others are long levers; none is moved by more than kMostLever times the depth at once.
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "physics/contact/collider_stage.h"
#include "physics/contact/triangle_shape.h"
#include "physics/model/clamp_to_int.h"
#include "physics/model/path.h"

namespace weft::physics {
namespace {

constexpr int kMostPlaces = 16;  // on the way of a fast collider
constexpr double kDeep = 3e-2;   // of an edge: one that was as deep is looked at again at once
constexpr int kPasses = 2;       // over a row of stretched triangles: a lift moves those beside it
constexpr int kTurns = 8;        // of one triangle in a substep
// Of an edge: how near a triangle at rest is known. An edge of it that lies along an edge of the body is
// nearest anywhere along that; the exact point jumps from end to end as it turns, and sheets draped over
// boxes swing for ever. Projections come to a point that moves as the triangle does.
constexpr double kSteady = 1e-2;
constexpr double kMostLever = 2;  // the greatest share of a corner; 1.37 where masses are equal
// Edges up to so many times the flat ones lie within the kernel's reach for those (kFaceReach).
constexpr double kReached = 2;
constexpr double kSudden = 5;   // m/s; of a blow by something else than the collider
constexpr double kShort = 1.5;  // times the flat ones: edges that need no reach of their own

struct Touch {
  Weights weights{};
  Vec3 normal{};
  double depth = 0;  // m; > 0: to be lifted by, at the end of the substep
};

// The first contact on the way of the triangle, seen from the collider.
template <class Shape>
Touch first_touch(const Shape& shape, double offset, const Corners& end, int places, double edge,
                  double tolerance) {
  for (int n = 1; n <= places; ++n) {
    const double left = 1 - double(n) / places;
    Corners c = end;
    for (int k = 0; k < 3; ++k) c.x[k] = minus(end.x[k], times(end.path[k], left));
    const Deepest d = deepest_on(shape, c, offset, edge, tolerance);
    if (d.nearest.distance >= offset) continue;
    const double beyond = dot(minus(c.at(d.weights), end.at(d.weights)), d.nearest.normal);
    return {d.weights, d.nearest.normal, offset - d.nearest.distance + std::max(0.0, beyond)};
  }
  return {};
}

// The links of a triangle's edges, which end where a tear goes through.
class Edges {
 public:
  explicit Edges(const LatticeParts& parts) : parts_(parts) {
    for (const Stencil& f : parts.stencils)
      for (std::size_t n = 0; n < kOffsets.size(); ++n)
        if (f.di == kOffsets[n][0] && f.dj == kOffsets[n][1]) links_[n] = f.links;
  }
  // The greatest difference of positions or velocities between two ends, of the triangles between rows j and
  // j+1 [m, m/s].
  double greatest(const Rows& values, int j) const {
    const Lattice& l = parts_.lattice;
    float square = 0;
    const auto look = [&](std::size_t edge, int row) {
      Stencil f;
      f.di = kOffsets[edge][0];
      f.dj = kOffsets[edge][1];
      f.links = links_[edge];
      square =
          std::max(square, parts_.kernels.greatest_square(far_rows(f, values, l.columns, row)));
    };
    look(kAlong, j);
    look(kAlong, j + 1);
    look(kAcross, j);
    look(kDiagonal, j);
    return std::sqrt(double(square));
  }
  // Whether the first or second triangle of square (i, j) is whole.
  bool whole(int i, int j, int triangle) const {
    const auto alive = [&](std::size_t edge, int row, int lane) {
      return !links_[edge] || links_[edge]->alive(row, lane);
    };
    return alive(kDiagonal, j, i) &&
           (triangle == 0 ? alive(kAlong, j, i) && alive(kAcross, j, i)
                          : alive(kAcross, j, i + 1) && alive(kAlong, j + 1, i));
  }

 private:
  static constexpr std::size_t kAlong = 0, kAcross = 1, kDiagonal = 2;
  static constexpr std::array<std::array<int, 2>, 3> kOffsets{{{1, 0}, {0, 1}, {-1, 1}}};
  const LatticeParts& parts_;
  std::array<Links*, 3> links_{};  // null: cannot tear
};

// What all cloths have in common: when a row's triangles are looked at, and how one is lifted.
class ColliderTriangles : public RowStage {
 public:
  // `particles`: what the stage of the particles has found.
  ColliderTriangles(const ClothParts& parts, const Collider& collider, const StartInside& start,
                    const SpeculativeCulling& particles, std::int64_t triangles)
      : RowStage(resolves(parts.cloth, collider) ? "stretched_faces" : "collider_faces",
                 resolves(parts.cloth, collider)
                     ? "triangles of the sheet where it is stretched"
                     : "triangles of the sheet against its small features",
                 1, triangles, "triangles"),
        cloth_(parts),
        collider_(parts, collider, start, true),
        far_(parts, collider_.fastest()),
        particles_(particles),
        resolved_(resolves(parts.cloth, collider)),
        upright_(collider.shape),
        edge_(longest_edge(parts.cloth)),
        allowed_(parts.cloth, collider),
        lengths_(std::size_t(parts.particles.rows)) {}

  double idle() const override { return far_.share(); }
  void follow(const Collider& collider) override {
    if (&collider != &collider_.collider()) return;
    collider_.follow_keys();
    far_.restart(collider_.fastest());
  }

  void restart() override {
    far_.restart(collider_.fastest());
    std::fill(lengths_.begin(), lengths_.end(), Length{});
  }

  using RowStage::run;
  void run(int begin, int end, const Substep& s) override {
    for (int j = begin; j < std::min(end, last_row()); ++j)
      if (!is_harmless(j, s) && !far_.skip(j, s)) keep_out(j, s);
  }

 protected:
  // Of the triangles that belong to row j: the greatest difference of positions or velocities between two
  // corners [m, m/s].
  virtual double greatest(const Rows& values, int j) const = 0;
  // Lifts them, where edges are no longer than `longest` [m]; tells how far the row is.
  virtual RowReach look(int j, const Substep& s, double longest) = 0;
  // Rows from there on have no triangles.
  virtual int last_row() const = 0;

  // Of the rows beside the triangles, as the stage before this one has found them.
  RowReach reach_of_particles(int j, const Substep& s) const {
    const int next = std::min(j + 1, cloth_.particles.rows - 1);
    const RowReach a = particles_.reach_at(j, s.time), b = particles_.reach_at(next, s.time);
    return {std::min(a.clearance, b.clearance), std::max(a.speed, b.speed)};
  }
  // How often the triangles of a row are gone through.
  int passes(double longest) const {
    return longest > AllowedDepth::kStretched * edge_ ? kPasses : 1;
  }
  // An edge or a corner of the collider leaves a triangle by one of its sides after another.
  void lift(const CollideRow& r, const std::array<int, 3>& j, const std::array<int, 3>& i) {
    for (int n = 0; n < kTurns && touch(r, j, i); ++n) continue;
  }
  const MovingCollider& collider() const { return collider_; }
  double edge() const { return edge_; }
  const AllowedDepth& allowed() const { return allowed_; }

 private:
  // The longest edge of the triangles between two rows. Until a time it is no longer than matters.
  struct Length {
    double longest = 0;                // m
    double measured = -1, until = -1;  // s
    bool harmless = false;
    bool known(double time) const { return time > measured && time < until; }
  };
  bool is_harmless(int j, const Substep& s) const {
    const Length& length = lengths_[std::size_t(j)];
    return length.harmless && length.known(s.time);
  }
  void keep_out(int j, const Substep& s) {
    Length& length = lengths_[std::size_t(j)];
    const bool known = length.known(s.time);
    const double longest = known ? length.longest : greatest(cloth_.particles.x, j);
    const double small = resolved_ ? allowed_.harmless() : kShort * edge_;
    const bool harmless = resolved_ && longest <= small;
    RowReach row = harmless ? reach_of_particles(j, s) : look(j, s, longest);
    if (!known) length = {longest, s.time, s.time + time_to_grow(j, small - longest), harmless};
    // A triangle's points are no nearer than its corners by more than an edge.
    row.clearance -= float(std::max(kShort * edge_, longest));
    far_.found(j, s, row, longest / edge_);
  }
  // Until an edge may be so much longer [s]: its ends part as fast as now, which may double, and what comes
  // suddenly adds to that.
  double time_to_grow(int j, double by) const {
    return std::max(0.0, by) /
           (2 * greatest(cloth_.particles.v, j) + kSudden + collider_.fastest());
  }

  // Lifts one triangle out once; whether it may be in by another side still.
  bool touch(const CollideRow& r, const std::array<int, 3>& j, const std::array<int, 3>& i) {
    Particles& l = cloth_.particles;
    const Vec3 place{r.cx, r.cy, r.cz}, u{r.ux, r.uy, r.uz};
    std::array<Vec3, 3> v;
    Corners c;
    double path = 0;
    for (int k = 0; k < 3; ++k) {
      v[k] = minus({l.v.at(0, j[k], i[k]), l.v.at(1, j[k], i[k]), l.v.at(2, j[k], i[k])}, u);
      c.x[k] = upright_.into(
          minus({l.x.at(0, j[k], i[k]), l.x.at(1, j[k], i[k]), l.x.at(2, j[k], i[k])}, place));
      c.path[k] = upright_.into(times(v[k], r.dt));
      path = std::max(path, std::sqrt(dot(c.path[k], c.path[k])));
    }
    // It rests as deep as may be: lifted all the way it would fall back and ring.
    const double longest = longest_side(c.x);
    const double offset = r.offset - allowed_.at(longest);
    const bool stretched = longest > AllowedDepth::kStretched * edge_;
    Touch touch = std::visit(
        [&](const auto& shape) {
          const double size = std::max(feature_of(shape) + r.offset, 0.02 * edge_);
          const int places = clamp_to_int(std::ceil(2 * path / size), 1, kMostPlaces);
          return first_touch(shape, offset, c, places, edge_, stretched ? kExact : kSteady);
        },
        upright_.shape);
    if (touch.depth <= 0) return false;
    touch.normal = upright_.out_of(touch.normal);
    std::array<double, 3> share;
    double mobility = 0, greatest = 0;
    Vec3 speed{};
    for (int k = 0; k < 3; ++k) {
      share[k] = l.w(j[k], i[k]) * touch.weights[k];
      mobility += share[k] * touch.weights[k];
      greatest = std::max(greatest, share[k]);
      speed = plus(speed, times(v[k], touch.weights[k]));
    }
    if (mobility <= 0) return false;
    const bool lever = greatest > kMostLever * mobility;
    const double scale = lever ? kMostLever / greatest : 1 / mobility;
    const auto [moved, gained] = rub(r, touch, speed);
    for (int k = 0; k < 3; ++k)
      for (int m = 0; m < 3; ++m) {
        l.x.at(m, j[k], i[k]) = coordinate(l.x.at(m, j[k], i[k]) + scale * share[k] * moved[m]);
        l.v.at(m, j[k], i[k]) = float(l.v.at(m, j[k], i[k]) + scale * share[k] * gained[m]);
      }
    return !lever && touch.depth > kDeep * edge_;
  }

  // Changes of position and velocity of the touching point, as a particle's in collide.h.
  static std::pair<Vec3, Vec3> rub(const CollideRow& r, const Touch& touch, const Vec3& speed) {
    const double into = dot(speed, touch.normal);
    const Vec3 tangential = minus(speed, times(touch.normal, into));
    const double distance = std::sqrt(dot(tangential, tangential)) * r.dt;
    const double pressed = std::max(0.0, -into * r.dt);
    const double rubbed = distance <= r.friction_static * pressed
                              ? 1
                              : std::min(1.0, r.friction_dynamic * pressed / distance);
    const Vec3 lost = times(tangential, -rubbed);
    return {plus(times(touch.normal, touch.depth), times(lost, r.dt)),
            plus(times(touch.normal, std::max(0.0, -into)), lost)};
  }

  ClothParts cloth_;
  MovingCollider collider_;
  SpeculativeCulling far_;
  const SpeculativeCulling& particles_;
  const bool resolved_;  // the mesh at rest resolves the collider
  Upright upright_;
  double edge_;  // m, longest of a flat triangle
  AllowedDepth allowed_;
  std::vector<Length> lengths_;  // of every row
};

// Of a grid: two of every square, between its row and the next, found by a kernel.
class SquareTriangles final : public ColliderTriangles {
 public:
  SquareTriangles(const LatticeParts& parts, const Collider& collider, const StartInside& start,
                  const SpeculativeCulling& particles)
      : ColliderTriangles(parts, collider, start, particles,
                          2 * std::int64_t(parts.lattice.columns - 1) * (parts.lattice.rows - 1)),
        parts_(parts),
        edges_(parts_) {}

  void reserve_slots(int slots) override {
    bound_ = Rows(slots, parts_.lattice.stride);
    room_ = AlignedArray<std::int32_t>(room() * std::size_t(slots));
  }
  std::size_t bytes() const override {
    return bound_.bytes() + room_.size() * sizeof(std::int32_t);
  }

 private:
  int last_row() const override { return parts_.lattice.rows - 1; }
  double greatest(const Rows& values, int j) const override { return edges_.greatest(values, j); }

  RowReach look(int j, const Substep& s, double longest) override {
    Lattice& l = parts_.lattice;
    FacesRow f;
    f.row = collider().row(parts_, j, s);
    f.x_next = l.x.row(j + 1);
    f.v_next = l.v.row(j + 1);
    f.edge = float(std::max(edge(), longest / kReached));
    f.slack = float(allowed().at(longest));
    const Row3 bound = bound_.row(s.slot);
    f.bound[0] = bound.x;
    f.bound[1] = bound.y;
    f.room = room_.data() + room() * std::size_t(s.slot);
    const RowReach reach = parts_.kernels.collider[collider().shape()]->below_faces(f);
    // The way of a substep matters only where it is long against the collider.
    const float way = reach.speed * f.row.dt;
    const float near = way > 0.5f * f.row.shape.thin ? way : -f.slack;
    for (int pass = 0; pass < passes(longest); ++pass)
      for (int i = 0; i + 1 < l.columns; ++i) {
        if (f.bound[0][i] < near && edges_.whole(i, j, 0))
          lift(f.row, {j, j, j + 1}, {i, i + 1, i});
        if (f.bound[1][i] < near && edges_.whole(i, j, 1))
          lift(f.row, {j, j + 1, j + 1}, {i + 1, i + 1, i});
      }
    return reach;
  }

  std::size_t room() const { return 2 * std::size_t(parts_.lattice.stride) + 16; }

  LatticeParts parts_;
  Edges edges_;
  Rows bound_;
  AlignedArray<std::int32_t> room_;
};

// Of a mesh: each belongs to the first row that it reaches.
class MeshTriangles final : public ColliderTriangles {
 public:
  MeshTriangles(const ClothParts& parts, const Collider& collider, const StartInside& start,
                const SpeculativeCulling& particles)
      : ColliderTriangles(parts, collider, start, particles,
                          std::int64_t(parts.model.surface().triangles.size())),
        parts_(parts),
        rows_(std::size_t(parts.particles.rows)) {
    for (const auto& corners : parts.model.surface().triangles) {
      Placed t;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto [j, i] = parts.particles.place(corners[k]);
        t.j[k] = j, t.i[k] = i;
      }
      const auto [first, last] = std::minmax_element(t.j.begin(), t.j.end());
      assert(*last - *first <= reach);
      rows_[std::size_t(*first)].push_back(t);
    }
  }

  std::size_t bytes() const override { return std::size_t(items) * sizeof(Placed); }

 private:
  struct Placed {
    std::array<int, 3> j, i;  // row and lane of the corners
  };

  int last_row() const override { return parts_.particles.rows; }
  double greatest(const Rows& values, int j) const override {
    double square = 0;
    for (const Placed& t : rows_[std::size_t(j)])
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t next = (k + 1) % 3;
        Vec3 e{};
        for (int m = 0; m < 3; ++m)
          e[std::size_t(m)] =
              double(values.at(m, t.j[next], t.i[next])) - values.at(m, t.j[k], t.i[k]);
        square = std::max(square, dot(e, e));
      }
    return std::sqrt(square);
  }

  RowReach look(int j, const Substep& s, double longest) override {
    const RowReach near = reach_of_particles(j, s);
    const CollideRow row = collider().row(parts_, j, s);
    // No point of a triangle is further from a corner than its longest side.
    const double way = near.speed * s.dt + longest;
    if (near.clearance > way) return near;
    for (int pass = 0; pass < passes(longest); ++pass)
      for (const Placed& t : rows_[std::size_t(j)]) lift(row, t.j, t.i);
    return near;
  }

  ClothParts parts_;
  std::vector<std::vector<Placed>> rows_;
};

}  // namespace

std::unique_ptr<RowStage> make_collider_triangles(const LatticeParts& parts,
                                                  const Collider& collider,
                                                  const StartInside& start,
                                                  const SpeculativeCulling& particles) {
  if (!caught_by_triangles(collider)) return nullptr;
  if (resolves(parts.cloth, collider) && parts.stencils.empty()) return nullptr;
  return std::make_unique<SquareTriangles>(parts, collider, start, particles);
}

std::unique_ptr<RowStage> make_collider_triangles(const ClothParts& parts, const Collider& collider,
                                                  const StartInside& start,
                                                  const SpeculativeCulling& particles) {
  if (!caught_by_triangles(collider) || parts.model.surface().triangles.empty()) return nullptr;
  return std::make_unique<MeshTriangles>(parts, collider, start, particles);
}

}  // namespace weft::physics
