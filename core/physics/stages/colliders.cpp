// Stage "collider": one collider against the particles of one cloth.
#include "physics/stages/colliders.h"

#include <cmath>

#include "physics/path.h"

namespace weft::physics {
namespace {

const char* const kShapeNames[kShapes] = {"sphere", "plane", "capsule", "box"};

std::string detail_of(const Collider& c) {
  return std::string(kShapeNames[c.shape.index()]) +
         (c.friction.model == FrictionModel::course ? ", course friction" : ", Coulomb friction") +
         (c.keys.empty() ? "" : ", moving");
}

class ColliderStage final : public RowStage {
 public:
  ColliderStage(const ClothParts& parts, const Collider& collider)
      : RowStage("collider", detail_of(collider), 0, parts.particles(), "particles"),
        parts_(parts),
        collider_(parts, collider),
        far_(parts, collider_.fastest()),
        kernel_(
            parts.kernels.collide[collider.shape.index()][std::size_t(collider.friction.model)]) {}

  void run(int j, const Substep& s) override {
    if (far_.skip(j, s)) return;
    far_.found(j, s, kernel_(collider_.row(parts_, j, s)));
  }
  double idle() const override { return far_.share(); }
  void follow(const Collider& collider) override {
    if (&collider != &collider_.collider()) return;
    collider_.follow_keys();
    far_.restart(collider_.fastest());
  }

 private:
  ClothParts parts_;
  MovingCollider collider_;
  OutOfReach far_;
  RowReach (*kernel_)(const CollideRow&);
};

}  // namespace

StartInside start_inside(const Cloth& cloth, const Lattice& l, const Collider& collider,
                         double time) {
  StartInside found;
  found.time = time;
  if (collider.cuts) return found;
  for (int j = 0; j < l.rows; ++j)
    for (int i = 0; i < l.columns; ++i) {
      const Vec3 x{l.x.at(0, j, i), l.x.at(1, j, i), l.x.at(2, j, i)};
      const double depth = l.w(j, i) > 0 ? collider.offset - signed_distance(collider, time, x) : 0;
      found.deepest_particle = std::max(found.deepest_particle, depth);
      found.particles += depth > kTouchingStart;
    }
  if (found.particles == 0) found.deepest_particle = 0;
  find_triangles_inside(cloth, l, collider, found);
  return found;
}

double longest_edge(const Grid& grid) {
  return std::hypot(spacing_u(grid), spacing_v(grid));
}

bool resolves(const Cloth& cloth, const Collider& collider) {
  const double feature = std::visit([](const auto& s) { return feature_of(s); }, collider.shape);
  return feature + collider.offset > kSmallFeature * longest_edge(cloth.grid);
}

MovingCollider::MovingCollider(const ClothParts& parts, const Collider& collider, bool by_triangles)
    : collider_(collider),
      start_(parts.start_in(collider)),
      by_triangles_(by_triangles),
      growth_(kPulledFrames * parts.scene.time.frame) {
  CollideRow& r = constants_;
  r.friction_static = float(collider.friction.statik);
  r.friction_dynamic = float(collider.friction.dynamic);
  r.offset = float(collider.offset);
  r.resolved = resolves(parts.cloth, collider);
  std::visit(
      [&](const auto& shape) {
        const Vec3 place = place_of(shape);
        r.shape = constants_of(shape);
        r.cx = float(place[0]);
        r.cy = float(place[1]);
        r.cz = float(place[2]);
      },
      collider.shape);
  follow_keys();
}

void MovingCollider::follow_keys() {
  double along = 0;
  for (std::size_t n = 1; n < collider_.keys.size(); ++n) {
    const Key &a = collider_.keys[n - 1], &b = collider_.keys[n];
    const Vec3 e = minus(b.position, a.position);
    along = std::max(along, std::sqrt(dot(e, e)) / (b.time - a.time));
  }
  fastest_ = along + deepest() / growth_;
}

double MovingCollider::deepest() const {
  if (collider_.friction.model == FrictionModel::course) return 0;
  return by_triangles_ ? std::max(start_.deepest_particle, start_.deepest_triangle)
                       : start_.deepest_particle;
}

CollideRow MovingCollider::row(const ClothParts& parts, int j, const Substep& s) const {
  Lattice& l = parts.lattice;
  CollideRow r = constants_;
  r.columns = l.columns;
  r.x = l.x.row(j);
  r.v = l.v.row(j);
  r.w = l.w(j);
  r.dt = float(s.dt);
  r.inverse_dt = float(1 / s.dt);
  const double grown = (s.time - start_.time) / growth_;
  if (grown < 1) r.offset -= float(deepest() * (1 - grown));
  if (collider_.keys.empty()) return r;
  const Vec3 c = position_at(collider_.keys, s.time);
  const Vec3 u = velocity_over(collider_.keys, s.time, s.dt);
  r.cx = float(c[0]);
  r.cy = float(c[1]);
  r.cz = float(c[2]);
  r.ux = float(u[0]);
  r.uy = float(u[1]);
  r.uz = float(u[2]);
  return r;
}

OutOfReach::OutOfReach(const ClothParts& parts, double collider_speed)
    : rows_(parts.lattice.rows), acceleration_(1), collider_speed_(collider_speed) {
  constexpr double kStrain = 0.2;
  double heaviest = 0;
  for (int j = 0; j < parts.lattice.rows; ++j)
    for (int i = 0; i < parts.lattice.columns; ++i)
      heaviest = std::max(heaviest, double(parts.lattice.w(j, i)));
  for (const Family& f : parts.families)
    acceleration_ += 2 * f.stiffness * f.rest * kStrain * heaviest;
  const Vec3& g = parts.scene.gravity;
  acceleration_ += 2 * std::sqrt(dot(g, g));
}

void OutOfReach::restart(double collider_speed) {
  collider_speed_ = collider_speed;
  for (Row& row : rows_) row.resume = row.ran;
}

bool OutOfReach::skip(int j, const Substep& s) {
  Row& row = rows_[j];
  ++row.all;
  // A substep that is not later than the last one: the state was set back.
  const bool skipped = s.time > row.ran && s.time < row.resume;
  row.skipped += skipped;
  return skipped;
}

void OutOfReach::found(int j, const Substep& s, const RowReach& reach) {
  const double speed = 2 * (reach.speed + collider_speed_), a = acceleration_;
  const double c = std::max(0.0, double(reach.clearance));
  const double wait = (std::sqrt(speed * speed + 2 * a * c) - speed) / a;
  rows_[j].ran = s.time;
  rows_[j].resume = s.time + wait;
}

double OutOfReach::share() const {
  std::int64_t skipped = 0, all = 0;
  for (const Row& row : rows_) {
    skipped += row.skipped;
    all += row.all;
  }
  return all > 0 ? double(skipped) / double(all) : 0;
}

std::unique_ptr<RowStage> make_collider(const ClothParts& parts, const Collider& collider) {
  return std::make_unique<ColliderStage>(parts, collider);
}

}  // namespace weft::physics
