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
  double norm() const { return std::sqrt(x * x + y * y + z * z); }
};

struct PointMass {
  Vector3D position, last_position, forces;
  bool pinned = false;
};

enum SpringType { STRUCTURAL, SHEARING, BENDING };

struct Spring {
  PointMass *a, *b;
  double rest_length;
  SpringType type;
};

class CourseCloth final : public Peer {
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

 private:
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

  void build_springs() {
    const int nx = cloth_.grid.nx, ny = cloth_.grid.ny;
    const auto connect = [&](int i, int j, int oi, int oj, SpringType type) {
      if (oi < 0 || oi >= nx || oj < 0) return;
      PointMass *a = &point(i, j), *b = &point(oi, oj);
      springs_.push_back({a, b, (a->position - b->position).norm(), type});
    };
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        connect(i, j, i - 1, j, STRUCTURAL);
        connect(i, j, i, j - 1, STRUCTURAL);
        connect(i, j, i - 1, j - 1, SHEARING);
        connect(i, j, i + 1, j - 1, SHEARING);
        connect(i, j, i - 2, j, BENDING);
        connect(i, j, i, j - 2, BENDING);
      }
  }

  void simulate(double delta_t) {
    const double mass = weft::particle_mass(cloth_, 0, 0);
    const Vector3D gravity{scene_.gravity[0], scene_.gravity[1], scene_.gravity[2]};
    for (PointMass& p : points_) p.forces = gravity * mass;
    for (Spring& s : springs_) {
      const double ks = s.type == STRUCTURAL ? cloth_.stiffness.structural
                        : s.type == SHEARING ? cloth_.stiffness.shear
                                             : cloth_.stiffness.bend;
      const Vector3D between = s.b->position - s.a->position;
      const double length = between.norm();
      const Vector3D force = between / length * (ks * (length - s.rest_length));
      s.a->forces += force;
      s.b->forces -= force;
    }
    const double damping = cloth_.drag * delta_t;
    for (PointMass& p : points_) {
      if (p.pinned) continue;
      const Vector3D acceleration = p.forces / mass;
      const Vector3D before = p.position;
      p.position +=
          (p.position - p.last_position) * (1 - damping) + acceleration * (delta_t * delta_t);
      p.last_position = before;
    }
  }

  PointMass& point(int i, int j) { return points_[std::size_t(j * cloth_.grid.nx + i)]; }

  weft::Scene scene_;
  const weft::Cloth& cloth_;
  int substeps_;
  std::vector<PointMass> points_;
  std::vector<Spring> springs_;
};

}  // namespace

std::unique_ptr<Peer> make_course_peer(const weft::Scene& scene, int substeps) {
  return std::make_unique<CourseCloth>(scene, substeps);
}

}  // namespace bench
