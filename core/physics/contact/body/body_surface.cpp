#include "physics/contact/body/body_surface.h"

#include <cmath>

namespace weft {

using namespace physics;

namespace {

std::vector<Vec3> about_the_place(const MeshSource& source) {
  MeshSource about = source;
  about.translate = {};
  return placed_vertices(about);
}

}  // namespace

BodySurface::BodySurface(const TriangleMesh& mesh, std::vector<Vec3> vertices)
    : form_(mesh, vertices) {
  auto pose = std::make_shared<BodyPose>(form_, form_.split(vertices));
  const auto corners = [&](int n) {
    const auto& [a, b, c] = form_.triangles[std::size_t(n)];
    return Triangle{pose->vertices[std::size_t(a)], pose->vertices[std::size_t(b)],
                    pose->vertices[std::size_t(c)]};
  };
  const auto normal = [&](int n) -> const Vec3& { return pose->face_normals[std::size_t(n)]; };
  std::vector<Vec3> normals;
  for (std::size_t v = 0; v < pose->vertices.size(); ++v)
    normals.push_back(normal_at(form_, int(v), corners, normal));
  pose->vertex_normals = std::move(normals);
  least_radius_ = pose->least_radius();
  rest_ = std::move(pose);
}

BodySurface::BodySurface(const MeshSource& about, std::shared_ptr<const PointCache> motion,
                         double frame)
    : form_(*about.shape, about_the_place(about)), about_(about), motion_(std::move(motion)) {
  about_.translate = {};
  for (const float time : motion_->times)
    times_.push_back(double(time) * (motion_->in_frames ? frame : 1));
  travelled_.push_back(0);
  least_radius_ = std::numeric_limits<double>::infinity();
  std::vector<Vec3> last;
  for (int n = 0; n < motion_->samples(); ++n) {
    std::vector<Vec3> here = vertices(n);
    least_radius_ = std::min(least_radius_, least_radius_of(form_, here));
    if (n > 0) {
      double square = 0;
      for (std::size_t v = 0; v < last.size(); ++v) {
        const Vec3 d = minus(here[v], last[v]);
        square = std::max(square, dot(d, d));
      }
      travelled_.push_back(travelled_.back() + std::sqrt(square));
    }
    last = std::move(here);
  }
  if (!times_.empty()) fastest_ = fastest(times_.front(), times_.back());
}

BodyMoment BodySurface::at(double time) const {
  if (rest_) return {form_, rest_};
  const int after = next(time), last = motion_->samples();
  if (after == 0 || after == last) {
    const Pose held = pose(after == 0 ? 0 : last - 1);
    return {form_,
            held,
            held,
            0,
            after == 0 ? -1e300 : times_.back(),
            after == 0 ? times_.front() : 1e300};
  }
  const double begin = times_[std::size_t(after - 1)], end = times_[std::size_t(after)];
  return {form_, pose(after - 1), pose(after), (time - begin) / (end - begin), begin, end};
}

std::vector<Vec3> BodySurface::vertices(int sample) const {
  return form_.split(placed_vertices(about_, *motion_, sample));
}

BodySurface::Pose BodySurface::pose(int sample) const {
  const std::lock_guard lock(mutex_);
  const auto known = std::find_if(kept_.begin(), kept_.end(),
                                  [&](const auto& one) { return one.first == sample; });
  if (known != kept_.end()) {
    std::rotate(known, known + 1, kept_.end());
    return kept_.back().second;
  }
  if (kept_.size() == kKept) kept_.erase(kept_.begin());
  kept_.emplace_back(sample, std::make_shared<const BodyPose>(form_, vertices(sample)));
  return kept_.back().second;
}

int BodySurface::next(double time) const {
  return int(std::upper_bound(times_.begin(), times_.end(), time) - times_.begin());
}

double BodySurface::travelled(double time) const {
  const auto after = std::size_t(next(time));
  if (after == 0) return 0;
  if (after == times_.size()) return travelled_.back();
  const double share = (time - times_[after - 1]) / (times_[after] - times_[after - 1]);
  return between(travelled_[after - 1], travelled_[after], share);
}

double BodySurface::travel(double from, double to) const {
  return moves() ? std::abs(travelled(to) - travelled(from)) : 0;
}

double BodySurface::fastest(double from, double to) const {
  double most = 0;
  for (std::size_t n = 1; n < times_.size(); ++n)
    if (times_[n] > from && times_[n - 1] < to)
      most = std::max(most, (travelled_[n] - travelled_[n - 1]) / (times_[n] - times_[n - 1]));
  return most;
}

std::size_t BodySurface::bytes() const {
  if (rest_) return form_.bytes() + rest_->bytes();
  return form_.bytes() + motion_->places.size() * sizeof(PointCache::Place) +
         kKept * pose(0)->bytes();
}

std::shared_ptr<const BodySurface> surface_of(const MeshBody& body, double frame) {
  if (body.motion) return std::make_shared<const BodySurface>(body, body.motion, frame);
  return std::make_shared<const BodySurface>(*body.shape, about_the_place(body));
}

std::span<const std::array<int, 2>> open_edges(const BodySurface& surface) {
  return surface.form().open_edges;
}

}  // namespace weft
