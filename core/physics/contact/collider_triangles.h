// Stages "collider_faces" and "stretched_faces", of meshes followed by "lifted_faces": a collider with features smaller than the mesh as it is now
// is caught by the triangles that it would slip through between the particles (seed 000 names this failure).
// How deep a triangle may lie is said by AllowedDepth. Where the mesh at rest resolves the collider, rows are
// looked at closely only while a triangle of theirs is stretched (the second of the two). What a tear has
// ended is no triangle.
//
// The point p = Σ b_k x_k of a triangle deepest in the collider is lifted out by `depth` along the
// normal there, each corner by its share:  x_k += w_k b_k / (Σ w b²) n depth.  It rubs like a
// particle: p's velocity into the surface is lost, friction shortens the rest. Beside a held corner the
// others are long levers; none is moved by more than kMostLever times the depth at once.
#pragma once

#include <array>
#include <vector>

#include "physics/contact/body/feature_probe.h"
#include "physics/contact/collider_stage.h"
#include "physics/contact/triangle_shape.h"

namespace weft::physics {

// What all cloths have in common: when a row's triangles are looked at, and how one is lifted.
class ColliderTriangles : public ColliderRowStage {
 public:
  // `particles`: what the stage of the particles has found.
  ColliderTriangles(const ClothParts& parts, const Collider& collider, const StartInside& start,
                    const SpeculativeCulling& particles, std::int64_t triangles);

  void restart() override;
  void keep(Keeper& keeper) override;
  std::size_t bytes() const override { return features_ ? features_->bytes() : 0; }

  using RowStage::run;
  void run(int j, const Substep& s) override {
    if (j < last_row()) keep_out(j, s);
  }

 protected:
  // Of the triangles that belong to row j: the greatest difference of positions or velocities between two
  // corners [m, m/s].
  virtual double greatest(const Rows& values, int j) const = 0;
  // Looks at row j, unless it has nothing to do.
  void keep_out(int j, const Substep& s);
  // Lifts them, or finds which are to be lifted, where edges are no longer than `longest` [m]; tells how far the row is.
  virtual RowReach look(int j, const Substep& s, double longest) = 0;
  // Rows from there on have no triangles.
  virtual int last_row() const = 0;

  // Of the rows beside the triangles, as the stage before this one has found them.
  RowReach reach_of_particles(int j, const Substep& s) const;
  // Whether no triangle can touch, if the particles beside them lie so. No point of one is further from a
  // corner than its longest side.
  static bool out_of_reach(const RowReach& near, const Substep& s, double longest) {
    return near.clearance > near.speed * s.dt + longest;
  }
  // How often the triangles of a row are gone through.
  int passes(double longest) const;
  // An edge or a corner of the collider leaves a triangle by one of its sides after another. Tells whether it was moved.
  // `first`: a corner of it in the row that it belongs to.
  bool lift(const ColliderRow& r, const std::array<int, 3>& j, const std::array<int, 3>& i,
            std::size_t first = 0);
  // Whether lift() would move it as it lies now.
  bool touches(const ColliderRow& r, const std::array<int, 3>& j, const std::array<int, 3>& i,
               std::size_t first);
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
  // The deepest point of a triangle, to be lifted by `depth` along the normal at the end of the substep.
  struct Touch {
    Weights weights{};
    Vec3 normal{};
    double depth = 0;  // m; > 0: it touches
    Vec3 way{};        // m; how far the surface there has come, beside the collider
  };
  static Touch first_touch(const DeepestOnBody& d, double offset);
  template <class Shape>
  static Touch first_touch(const Shape& shape, double offset, const Corners& end, int places,
                           double edge, double tolerance);
  // Changes of position and velocity of the touching point, as a particle's in collide.h.
  static std::pair<Vec3, Vec3> rub(const CollideRow& r, const Touch& touch, const Vec3& speed);
  Vec3 past(const ColliderRow& r, int j, int i) const;
  Touch find(const ColliderRow& r, const std::array<int, 3>& j, const std::array<int, 3>& i,
             std::size_t first);
  // Until an edge may be so much longer [s]: its ends part as fast as now, which may double, and what comes
  // suddenly adds to that.
  double time_to_grow(int j, double by) const;

  // Lifts one triangle out once; whether it may be in by another side still.
  bool lift_once(const ColliderRow& r, const Touch& touch, const std::array<int, 3>& j,
                 const std::array<int, 3>& i);

  ClothParts cloth_;
  const SpeculativeCulling& particles_;
  const bool resolved_;  // the mesh at rest resolves the collider
  Upright upright_;
  double edge_;  // m, longest of a flat triangle
  AllowedDepth allowed_;
  std::vector<Length> lengths_;             // of every row
  std::unique_ptr<FeatureProbe> features_;  // of a body that is a mesh
};

}  // namespace weft::physics
