#include "scene/mesh/animation.h"

#include <cmath>
#include <filesystem>

#include "scene/json_text.h"
#include "scene/mesh/faces.h"
#include "weft/point_cache.h"

namespace weft {

std::vector<Vec3> placed_vertices(const MeshSource& mesh, const PointCache& motion, int sample) {
  const PointCache::Place* from = motion.sample(sample);
  std::vector<Vec3> placed(std::size_t(motion.points));
  for (std::size_t p = 0; p < placed.size(); ++p)
    for (std::size_t k = 0; k < 3; ++k) placed[p][k] = double(from[p][k]);
  text::put(mesh, placed);
  return placed;
}

namespace text {
namespace {

constexpr double kFarthest = 1e4, kShortest = 1e-6;  // m

double shortest_square(const TriangleMesh& mesh, const std::vector<Vec3>& x) {
  double shortest = kFarthest * kFarthest;
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 &a = x[std::size_t(t[k])], &b = x[std::size_t(t[(k + 1) % 3])];
      double square = 0;
      for (std::size_t m = 0; m < 3; ++m) square += (a[m] - b[m]) * (a[m] - b[m]);
      shortest = std::min(shortest, square);
    }
  return shortest;
}

// Files of as many vertices in another order are no fault by their counts.
void note_other_order(const MeshBody& body, const std::string& place,
                      std::vector<std::string>& notes) {
  constexpr double kLonger = 3;  // edges of a body that bends and grows are hardly so at its start
  const double edge = mean_edge(body);
  const double moved = mean_edge_at(*body.shape, placed_vertices(body, *body.motion, 0));
  if (moved > kLonger * edge || kLonger * moved < edge)
    notes.push_back(place + ": as the animation begins, edges of the mesh are " +
                    number_words(moved / edge) +
                    " times as long as in its file, in the mean; its vertices may be in another "
                    "order");
}

}  // namespace

std::optional<Fault> fault_of_motion(const MeshBody& body, const std::string& place) {
  if (!body.motion) return {};
  const PointCache& motion = *body.motion;
  if (motion.points != int(body.shape->vertices.size()))
    return Fault{place, "the animation has " + std::to_string(motion.points) + " points",
                 std::to_string(body.shape->vertices.size()) + ", the vertices of the mesh"};
  for (int n = 0; n < motion.samples(); ++n) {
    const std::vector<Vec3> x = placed_vertices(body, motion, n);
    const std::string sample = "sample " + std::to_string(n + 1) + " of the animation ";
    for (const Vec3& p : x)
      for (const double value : p)
        if (!(std::abs(value) <= kFarthest))
          return Fault{place, sample + "reaches " + std::to_string(value) + " m away",
                       "up to 10000 m"};
    if (shortest_square(*body.shape, x) < kShortest * kShortest)
      return Fault{place, sample + "has an edge below 1e-6 m", "edges of at least 1e-6 m"};
  }
  return {};
}

bool read_motion(const std::string& name, const std::string& folder, MeshBody& body,
                 const std::string& place, std::vector<Fault>& faults,
                 std::vector<std::string>& notes) {
  PointCacheFile file = read_point_cache((std::filesystem::path(folder) / name).string(),
                                         int(body.shape->vertices.size()));
  for (Fault& fault : file.faults)
    faults.push_back({place, fault.place + ": " + fault.what, fault.allowed});
  notes.insert(notes.end(), file.notes.begin(), file.notes.end());
  body.motion = file.cache;
  if (body.motion) note_other_order(body, place, notes);
  return file.faults.empty();
}

// What has a surface has been looked through when that was made.
void check_animation(const Collider& collider, const std::string& place, Check& result) {
  const MeshBody* body = std::get_if<MeshBody>(&collider.shape);
  if (!body && !collider.animation.empty())
    result.fault(place,
                 std::string("a ") + kShapeNames[collider.shape.index()] + " has an animation",
                 "a mesh, or keys");
  if (!body || !body->shape) return;
  if (body->surface && !body->motion && !collider.animation.empty())
    result.fault(place, "the animation is not read", "load_meshes() reads it");
  if (body->surface) return;
  if (const auto wrong = fault_of_motion(*body, place))
    result.fault(wrong->place, wrong->what, wrong->allowed);
}

}  // namespace text
}  // namespace weft
