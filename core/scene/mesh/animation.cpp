#include "scene/mesh/animation.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "scene/json_text.h"
#include "scene/mesh/faces.h"
#include "weft/point_cache.h"
#include "weft/random.h"
#include "weft/vec3.h"

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

double distance(const std::vector<Vec3>& x, int a, int b) {
  const Vec3 apart = minus(x[std::size_t(a)], x[std::size_t(b)]);
  return std::sqrt(dot(apart, apart));
}

double median(std::vector<double>& values) {
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// How long edges are in comparison with what vertices drawn at random, as often as they have edges, are apart, both in
// the median: small where neighbours are near each other, about 1 where vertices are in an order of another mesh.
double nearness(const TriangleMesh& mesh, const std::vector<Vec3>& x) {
  std::vector<double> edges, any;
  Random random(1, 0);
  const std::size_t count = mesh.triangles.size();
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& other = mesh.triangles[std::size_t(random.bits() % count)];
      edges.push_back(distance(x, t[k], t[(k + 1) % 3]));
      if (t[k] != other[k]) any.push_back(distance(x, t[k], other[k]));
    }
  return any.empty() ? 1 : median(edges) / median(any);
}

// Files of as many vertices in another order are no fault by their counts.
void note_other_order(const MeshBody& body, const std::string& place,
                      std::vector<std::string>& notes) {
  constexpr double kTold = 0.5;  // nearness; meshes of few vertices have none that are far apart
  constexpr double kLonger = 3;  // edges of a body that bends and grows are hardly so at its start
  const TriangleMesh& mesh = *body.shape;
  const std::vector<Vec3> begins = placed_vertices(body, *body.motion, 0);
  const double in_file = nearness(mesh, mesh.vertices), begun = nearness(mesh, begins);
  const bool mixed = in_file < kTold && begun > (1 + in_file) / 2;
  const double longer = mean_edge_at(mesh, begins) / mean_edge(body);
  const std::string begins_so = place + ": as the animation begins, ";
  if (mixed)
    notes.push_back(begins_so +
                    "neighbours in the mesh are about as far apart as any two vertices; its "
                    "vertices may be in another order");
  else if (longer > kLonger || kLonger * longer < 1)
    notes.push_back(begins_so + "edges of the mesh are " + number_words(longer) +
                    " times as long as in its file, in the mean; its unit may be another, or its "
                    "vertices may be in another order");
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
    if (auto wrong = fault_of_places(
            *body.shape, x, "sample " + std::to_string(n + 1) + " of the animation", place))
      return wrong;
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
    result.fault(place, "the animation is not read", "one whose file has been read");
  if (body->surface || fault_of(*body, place)) return;  // that is told where the mesh is looked at
  if (const auto wrong = fault_of_motion(*body, place))
    result.fault(wrong->place, wrong->what, wrong->allowed);
}

}  // namespace text
}  // namespace weft
