// The surface of a body that is a mesh, and how it moves by its animation: linear in time between samples, held
// before and after. Everything is seen from the body's place [m]. What is told has the same bits whatever was
// asked before, and may be asked by several threads at once.
//
// A closed body consists of parts that hang together, each a solid; where they overlap, the body is the
// union: its signed distance is the least of theirs. An open one has no inside: distances are not negative,
// normals point from it to the point that asks, and what a point meets lies on the side that it came from.
#pragma once

#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "physics/contact/body/body_moment.h"
#include "weft/point_cache.h"

namespace weft {

class BodySurface {
 public:
  using Point = physics::BodyMoment::Point;

  // `vertices`: those of the mesh, where they are about the place.
  BodySurface(const TriangleMesh& mesh, std::vector<Vec3> vertices);
  // Of a body that moves; `frame` [s]: of the scene.
  BodySurface(const MeshSource& about, std::shared_ptr<const PointCache> motion, double frame);

  // The surface at a time [s]; of one that keeps its form the same at all times.
  physics::BodyMoment at(double time = 0) const;

  bool closed() const { return form_.closed(); }
  bool moves() const { return motion_ != nullptr; }
  const physics::BodyForm& form() const { return form_; }
  std::size_t bytes() const;
  // The least radius of a feature at any time, infinite where none sticks out [m]; the mean length of an edge [m].
  double least_radius() const { return least_radius_; }
  double mean_edge() const { return form_.mean_edge; }
  // No vertex comes farther between two times [m].
  double travel(double from, double to) const;
  // Of a vertex, ever and between two times [m/s].
  double fastest() const { return fastest_; }
  double fastest(double from, double to) const;

 private:
  using Pose = std::shared_ptr<const physics::BodyPose>;
  static constexpr std::size_t kKept = 8;  // poses, of samples

  Pose pose(int sample) const;
  std::vector<Vec3> vertices(int sample) const;
  double travelled(double time) const;
  // The sample after a time, from 0 to the number of samples.
  int next(double time) const;

  physics::BodyForm form_;
  Pose rest_;  // of one that keeps its form
  MeshSource about_;
  std::shared_ptr<const PointCache> motion_;
  std::vector<double> times_, travelled_;  // of the samples: s, m since the first
  double least_radius_ = 0, fastest_ = 0;
  mutable std::mutex mutex_;
  mutable std::vector<std::pair<int, Pose>> kept_;  // the latest last
};

}  // namespace weft
