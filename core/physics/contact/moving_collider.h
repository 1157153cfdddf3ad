// What the collider stages share: where a collider is during a substep, and which rows are too far
// from it to matter.
#pragma once

#include <optional>

#include "physics/contact/body/body_passage.h"
#include "physics/contact/colliders/shapes.h"
#include "physics/model/cloth_model.h"
#include "physics/model/placement.h"

namespace weft::physics {

// What of a cloth lies inside a collider and can move when the two first meet, at the start or when the
// collider is put where the cloth is: particles, and triangles where those catch the collider, and how
// deep at most [m].
struct StartInside {
  double time = 0;  // s
  std::int64_t particles = 0, triangles = 0;
  double deepest_particle = 0, deepest_triangle = 0;
};

// Frames over which a collider that holds part of a sheet when they first meet grows to its size.
inline constexpr int kPulledFrames = 10;

// Of a flat triangle of the cloth [m].
double longest_edge(const Cloth& cloth);

// A cloth resolves a collider (weft/shape.h) whose features are larger than so many of those edges.
inline constexpr double kSmallFeature = 1.5;

// How deep a triangle of the cloth may lie below a collider's offset surface.
//
// With its corners on a surface of curvature radius R, the middle of an edge of length e lies below it by
//   s(e) = R - sqrt(R² - e²/4).
// Where the mesh at rest resolves the collider, that is left to the offset, and triangles that are hardly
// longer than at rest may lie so deep. The more one is stretched the less it may: from kStretched times
// its length on, half of the offset, so that no point of it is inside the body. Where the mesh does not
// resolve the collider no triangle may lie deeper than kSlack of an edge.
class AllowedDepth {
 public:
  static constexpr double kSlack = 1e-3;  // of a flat triangle's longest edge
  static constexpr double kTight = 1e-4;  // the same, where the mesh at rest resolves the collider
  static constexpr double kAtRest = 1.1;  // times that edge: as good as not stretched
  static constexpr double kStretched = 1.5;  // times that edge

  AllowedDepth(const Cloth& cloth, const Collider& collider);
  // Of a triangle with this longest edge [m].
  double at(double longest) const;
  // Triangles with no longer edges [m] are as deep as they may be when their corners are on the surface.
  double harmless() const { return harmless_; }

 private:
  double edge_;       // m
  double at_rest_;    // m; 0 where the mesh does not resolve the collider
  double stretched_;  // m
  double harmless_;   // m
};

// Whether triangles, too, can get into a collider whose particles are all out of it.
bool caught_by_triangles(const Collider& collider);

// One row and the collider, and, where that is a mesh, how its surface has come there.
struct ColliderRow : CollideRow {
  double time = 0;               // s, at the end of the substep
  std::optional<Matrix> turn{};  // of a collider that ever turns, as Placement's, then
  BodyPassage body{};

  // As Placement's and RigidMotion's, of what lies about the place as kernels have it.
  Vec3 about_place(const Vec3& point) const { return minus(point, {cx, cy, cz}); }
  Vec3 into(const Vec3& way) const { return turn ? times_transpose(*turn, way) : way; }
  Vec3 out_of(const Vec3& way) const { return turn ? times(*turn, way) : way; }
  Vec3 carried(const Vec3& about_place, const Vec3& v) const;
};

// A collider in motion, as the kernels take it. What is inside when it meets the cloth would be torn
// from its neighbours if it were put onto the surface at once: the collider begins as much smaller as
// the deepest of it lies below the surface.
class MovingCollider {
 public:
  // by_triangles: triangles, too, are kept out.
  // `start`: what of the cloth was inside when the two met; it outlives this.
  MovingCollider(const ClothParts& parts, const Collider& collider, const StartInside& start,
                 bool by_triangles = false);
  // The collider at the end of the substep, and row j of the cloth.
  ColliderRow row(const ClothParts& parts, int j, const Substep& s) const;
  // Greatest speed along its keys, of its turn, of its animation and of its growth [m/s].
  double fastest() const { return fastest_; }
  // Takes up keys, and what is inside, when they have changed.
  void follow_keys();
  const Collider& collider() const { return collider_; }
  std::size_t shape() const { return collider_.shape.index(); }

 private:
  double deepest() const;  // m below the surface when they met
  void place(ColliderRow& row, const Substep& s) const;

  const Collider& collider_;
  const BodySurface* body_;  // of a mesh
  CollideRow constants_{};
  double fastest_ = 0, rim_ = 0;  // m/s
  const StartInside& start_;
  const bool by_triangles_;
  const double growth_;  // s, until it has grown
};

// Rows that cannot touch a collider before a time. A particle at distance c, of speed s towards the
// collider, gets there no sooner than after τ with 2 s τ + a τ²/2 = c, where a is more than springs
// at a strain of 20 %, gravity and a gas give it; speeds may double besides by contact. Should one be
// faster yet it is found inside later, and lifted out then.
class SpeculativeCulling {
 public:
  SpeculativeCulling(const ClothParts& parts, double collider_speed);
  // Whether row j has nothing to do in this substep.
  bool skip(int j, const Substep& s);
  // All rows are looked at again: the collider's path has changed, or the state was set.
  void restart(double collider_speed);
  // Row j has just been worked on and lies so. `stretch`: how many times as long as at rest its edges are.
  void found(int j, const Substep& s, const RowReach& reach, double stretch = 1);
  // What row j keeps at least of its clearance until then [m], and its greatest speed [m/s].
  RowReach reach_at(int j, double time) const;
  void keep(Keeper& keeper);
  // Share of the rows so far that were skipped.
  double share() const;

 private:
  struct Row {
    double ran = -1, resume = -1;  // s
    RowReach reach{};              // as it ran
    std::int64_t skipped = 0, all = 0;
  };
  // How much nearer a row of this speed may have come after a time [s].
  double approach(double speed, double time) const;

  std::vector<Row> rows_;
  double acceleration_, collider_speed_;
};

}  // namespace weft::physics
