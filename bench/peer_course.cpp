// A course-style solver, written plainly (peer.h). It is what one gets by following the seeds'
// description word for word; nothing here is made slow on purpose.
#include <cmath>

#include "peer.h"

namespace bench {
namespace {

struct Vector3D {
  double x = 0, y = 0, z = 0;
  Vector3D operator+(const Vector3D& o) const { return {x + o.x, y + o.y, z + o.z}; }
  Vector3D operator-(const Vector3D& o) const { return {x - o.x, y - o.y, z - o.z}; }
  Vector3D operator*(double s) const { return {x * s, y * s, z * s}; }
  Vector3D operator/(double s) const { return {x / s, y / s, z / s}; }
  void operator+=(const Vector3D& o) { *this = *this + o; }
  void operator-=(const Vector3D& o) { *this = *this - o; }
  double dot(const Vector3D& o) const { return x * o.x + y * o.y + z * o.z; }
  double norm() const { return std::sqrt(dot(*this)); }
};

struct PointMass {
  Vector3D position, last_position, forces;
  bool pinned = false;
};

struct Spring {
  PointMass *a, *b;
  double rest_length, ks, damping;
};

class CourseCloth final : public CoursePeer {
 public:
  CourseCloth(const weft::Scene& scene, int substeps)
      : scene_(scene), cloth_(scene_.cloths[0]), substeps_(substeps) {
    build_points();
    build_springs();
  }

  void advance_frame() override {
    for (int s = 0; s < substeps_; ++s) simulate(scene_.time.frame / substeps_);
  }

  std::vector<double> positions() const override {
    std::vector<double> all;
    for (const PointMass& p : points_)
      all.insert(all.end(), {p.position.x, p.position.y, p.position.z});
    return all;
  }

  std::vector<double> velocities() const override {
    std::vector<double> all;
    for (const PointMass& p : points_) {
      const Vector3D v = (p.position - p.last_position) / delta_t();
      all.insert(all.end(), {v.x, v.y, v.z});
    }
    return all;
  }

  void set_state(const std::vector<double>& x, const std::vector<double>& v) override {
    for (std::size_t n = 0; n < points_.size(); ++n) {
      PointMass& p = points_[n];
      p.position = {x[3 * n], x[3 * n + 1], x[3 * n + 2]};
      p.last_position = p.position - Vector3D{v[3 * n], v[3 * n + 1], v[3 * n + 2]} * delta_t();
    }
  }

 private:
  double delta_t() const { return scene_.time.frame / substeps_; }

  void build_points() {
    const weft::Grid& g = cloth_.grid;
    for (int j = 0; j < g.ny; ++j)
      for (int i = 0; i < g.nx; ++i) {
        const double s = double(i) / (g.nx - 1), t = double(j) / (g.ny - 1);
        PointMass p;
        p.position = {g.origin[0] + s * g.u[0] + t * g.v[0], g.origin[1] + s * g.u[1] + t * g.v[1],
                      g.origin[2] + s * g.u[2] + t * g.v[2]};
        p.last_position = p.position;
        points_.push_back(p);
      }
    for (const weft::Pin& pin : cloth_.pins) point(pin.i, pin.j).pinned = true;
  }

  void connect(int i, int j, int oi, int oj, double ks, double damping) {
    if (oi < 0 || oi >= cloth_.grid.nx || oj < 0 || ks == 0) return;
    PointMass *a = &point(i, j), *b = &point(oi, oj);
    springs_.push_back({a, b, (a->position - b->position).norm(), ks, damping});
  }

  void build_springs() {
    const weft::Kinds &ks = cloth_.stiffness, &damping = cloth_.spring_damping;
    for (int j = 0; j < cloth_.grid.ny; ++j)
      for (int i = 0; i < cloth_.grid.nx; ++i) {
        for (int n = 1; n <= cloth_.level; ++n)
          for (const int di : {-n, 0, n})
            if (di <= 0 || cloth_.level_diagonals == weft::LevelDiagonals::both)
              connect(i, j, i + di, j - n, ks.structural, damping.structural);
        for (int n = 1; n <= cloth_.level; ++n)
          connect(i, j, i - n, j, ks.structural, damping.structural);
        if (cloth_.level > 0) continue;
        connect(i, j, i - 1, j, ks.structural, damping.structural);
        connect(i, j, i, j - 1, ks.structural, damping.structural);
        connect(i, j, i - 1, j - 1, ks.shear, damping.shear);
        connect(i, j, i + 1, j - 1, ks.shear, damping.shear);
        connect(i, j, i - 2, j, ks.bend, damping.bend);
        connect(i, j, i, j - 2, ks.bend, damping.bend);
      }
  }

  void add_spring_forces() {
    for (Spring& s : springs_) {
      const Vector3D between = s.b->position - s.a->position;
      const double length = between.norm();
      const Vector3D direction = between / length;
      Vector3D force = direction * (s.ks * (length - s.rest_length));
      if (s.damping > 0) {
        const Vector3D va = (s.a->position - s.a->last_position) / delta_t();
        const Vector3D vb = (s.b->position - s.b->last_position) / delta_t();
        force += direction * (s.damping * direction.dot(vb - va));
      }
      s.a->forces += force;
      s.b->forces -= force;
    }
  }

  void satisfy_constraints() {
    for (int n = 0; n < scene_.solver.iterations; ++n)
      for (Spring& s : springs_) {
        const Vector3D between = s.b->position - s.a->position;
        const double length = between.norm();
        const Vector3D correction = between / length * (length - s.rest_length);
        if (!s.a->pinned) s.a->position += correction * cloth_.positional_k;
        if (!s.b->pinned) s.b->position -= correction * cloth_.positional_k;
      }
  }

  void collide(PointMass& p) {
    for (const weft::Collider& c : scene_.colliders) {
      const auto* ball = std::get_if<weft::Sphere>(&c.shape);
      if (!ball) continue;
      const Vector3D center{ball->center[0], ball->center[1], ball->center[2]};
      const Vector3D v = p.position - center;
      if (v.norm() < ball->radius) p.position = center + v / v.norm() * ball->radius;
    }
  }

  void simulate(double delta_t) {
    const double mass = weft::particle_mass(cloth_, 0, 0);
    const Vector3D gravity{scene_.gravity[0], scene_.gravity[1], scene_.gravity[2]};
    for (PointMass& p : points_) p.forces = gravity * mass;
    const bool rigid = scene_.solver.method == weft::Method::positional;
    if (!rigid) add_spring_forces();
    const double damping = cloth_.drag * delta_t;
    for (PointMass& p : points_) {
      if (p.pinned) continue;
      const Vector3D acceleration = p.forces / mass;
      const Vector3D before = p.position;
      p.position +=
          (p.position - p.last_position) * (1 - damping) + acceleration * (delta_t * delta_t);
      p.last_position = before;
    }
    if (rigid) satisfy_constraints();
    if (scene_.colliders.empty()) return;
    for (PointMass& p : points_)
      if (!p.pinned) collide(p);
  }

  PointMass& point(int i, int j) { return points_[std::size_t(j * cloth_.grid.nx + i)]; }

  weft::Scene scene_;
  const weft::Cloth& cloth_;
  int substeps_;
  std::vector<PointMass> points_;
  std::vector<Spring> springs_;
};

}  // namespace

std::unique_ptr<CoursePeer> make_course_peer(const weft::Scene& scene, int substeps) {
  return std::make_unique<CourseCloth>(scene, substeps);
}

}  // namespace bench
