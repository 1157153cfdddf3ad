// Meshes of a scene: read, and put where the scene has them.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>

#include "scene/json_text.h"
#include "scene/mesh/animation.h"
#include "scene/mesh/faces.h"
#include "scene/mesh/unjoined.h"
#include "weft/mesh.h"
#include "weft/vec3.h"

namespace weft {
namespace {

constexpr double kFarthest = 1e4, kLarge = 100, kShortest = 1e-6;  // m

// Turned about one axis.
void turn(std::vector<Vec3>& points, std::size_t axis, double degrees) {
  const double angle = degrees * std::numbers::pi / 180, c = std::cos(angle), s = std::sin(angle);
  const std::size_t a = (axis + 1) % 3, b = (axis + 2) % 3;
  for (Vec3& p : points) {
    const Vec3 q = p;
    p[a] = c * q[a] - s * q[b];
    p[b] = s * q[a] + c * q[b];
  }
}

void note_size(const MeshSource& mesh, const std::string& place, std::vector<std::string>& notes) {
  const std::vector<Vec3> x = placed_vertices(mesh);
  Vec3 low = x[0], high = x[0];
  for (const Vec3& p : x)
    for (std::size_t k = 0; k < 3; ++k)
      low[k] = std::min(low[k], p[k]), high[k] = std::max(high[k], p[k]);
  const double size = std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
  if (size > kLarge && size < 2 * kFarthest)
    notes.push_back(place + ": the mesh is " + std::to_string(std::lround(size)) +
                    " m across; scale says how long the file's unit is");
}

// Whether triangles are of vertices that are there, as those of files are.
bool has_corners(const TriangleMesh& mesh) {
  const auto there = [&](int corner) {
    return corner >= 0 && std::size_t(corner) < mesh.vertices.size();
  };
  return !mesh.triangles.empty() && (mesh.uv.empty() || mesh.uv.size() == mesh.triangles.size()) &&
         std::all_of(mesh.triangles.begin(), mesh.triangles.end(),
                     [&](const auto& t) { return std::all_of(t.begin(), t.end(), there); });
}

// The first of the shortest edges, and its length [m].
struct Edge {
  int a = 0, b = 0;
  double length = std::numeric_limits<double>::infinity();
};
Edge shortest_edge(const TriangleMesh& mesh, const std::vector<Vec3>& x) {
  Edge shortest;
  double least = std::numeric_limits<double>::infinity();
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      const Vec3 side = minus(x[std::size_t(a)], x[std::size_t(b)]);
      const double square = dot(side, side);
      if (square < least) least = square, shortest = {a, b, std::sqrt(square)};
    }
  return shortest;
}

}  // namespace

std::optional<Fault> text::fault_of(const MeshSource& mesh, const std::string& place) {
  if (!has_corners(*mesh.shape))
    return Fault{place, "the mesh has no triangles, or they are not of its vertices",
                 "corners from 0 to the number of vertices less one, uv of all triangles or none"};
  return fault_of_places(*mesh.shape, placed_vertices(mesh), "the mesh", place + "/scale");
}

std::optional<Fault> text::fault_of_places(const TriangleMesh& mesh, const std::vector<Vec3>& x,
                                           const std::string& called, const std::string& place) {
  for (std::size_t n = 0; n < x.size(); ++n)
    for (const double value : x[n])
      if (!(std::abs(value) <= kFarthest))
        return Fault{place,
                     called + " reaches " + number_words(std::abs(value)) + " m away, at vertex " +
                         std::to_string(n) + " (counted from 0)",
                     "-10000 to 10000 m along each axis"};
  if (const Edge edge = shortest_edge(mesh, x); edge.length < kShortest)
    return Fault{place,
                 called + " has an edge of " + number_words(edge.length) + " m, between vertices " +
                     std::to_string(edge.a) + " and " + std::to_string(edge.b) +
                     " (counted from 0)",
                 "edges of at least 1e-6 m"};
  return {};
}

void text::put(const MeshSource& mesh, std::vector<Vec3>& points) {
  for (Vec3& p : points)
    for (double& value : p) value *= mesh.scale;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (mesh.rotate[axis] != 0) turn(points, axis, mesh.rotate[axis]);
  for (Vec3& p : points)
    for (std::size_t k = 0; k < 3; ++k) p[k] += mesh.translate[k];
}

std::vector<Vec3> placed_vertices(const MeshSource& mesh) {
  std::vector<Vec3> placed = mesh.shape->vertices;
  text::put(mesh, placed);
  return placed;
}

Vec3 placed_vertex(const MeshSource& mesh, int vertex) {
  std::vector<Vec3> placed{mesh.shape->vertices[std::size_t(vertex)]};
  text::put(mesh, placed);
  return placed.front();
}

double text::mean_edge_at(const TriangleMesh& mesh, const std::vector<Vec3>& x) {
  double sum = 0;
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 &a = x[std::size_t(t[k])], &b = x[std::size_t(t[(k + 1) % 3])];
      sum += std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
    }
  return sum / (3 * double(mesh.triangles.size()));
}

double mean_edge(const MeshSource& mesh) {
  return text::mean_edge_at(*mesh.shape, placed_vertices(mesh));
}

void load_meshes(Scene& scene, const std::string& folder, std::vector<Fault>& faults,
                 std::vector<std::string>& notes) {
  std::vector<std::size_t> fresh;  // cloths whose meshes come now
  for (std::size_t c = 0; c < scene.cloths.size(); ++c)
    if (scene.cloths[c].mesh.given() && !scene.cloths[c].mesh.shape) fresh.push_back(c);
  for_each_mesh(scene, [&](MeshSource& mesh, const std::string& place) {
    if (mesh.file.empty() || mesh.shape) return;
    MeshFile file = read_mesh((std::filesystem::path(folder) / mesh.file).string());
    // A word that is none of those of `rest` is taken for a file.
    const bool word = place.ends_with("/rest") && !is_mesh_file(mesh.file);
    for (Fault& fault : file.faults)
      faults.push_back({place_of_file(place), fault.place + ": " + fault.what,
                        (word ? "shape, flat, uv, or a file: " : "") + fault.allowed});
    notes.insert(notes.end(), file.notes.begin(), file.notes.end());
    if (!file.faults.empty()) return;
    mesh.shape = std::make_shared<const TriangleMesh>(std::move(file.mesh));
    if (!place.ends_with("/rest")) note_size(mesh, place, notes);
  });
  for (const std::size_t c : fresh)
    if (scene.cloths[c].mesh.shape)
      text::note_unjoined(scene.cloths[c], "/cloths/" + std::to_string(c), notes);
  for (std::size_t n = 0; n < scene.colliders.size(); ++n) {
    Collider& collider = scene.colliders[n];
    MeshBody* body = std::get_if<MeshBody>(&collider.shape);
    if (!body || !body->shape) continue;
    const std::string place = "/colliders/" + std::to_string(n) + "/animation";
    if (!collider.animation.empty() && !body->motion &&
        !text::read_motion(collider.animation, folder, *body, place, faults, notes))
      continue;
    if (!body->surface && !text::fault_of(*body, "") && !text::fault_of_motion(*body, ""))
      body->surface = surface_of(*body, scene.time.frame);
  }
}

void use_full_paths(Scene& scene, const std::string& folder) {
  for_each_mesh_file(scene, [&](std::string& file) {
    file = std::filesystem::absolute(std::filesystem::path(folder) / file).string();
  });
}

void MeshStore::take(const Scene& scene) {
  for_each_mesh(scene, [&](const auto& mesh, const std::string&) {
    if (mesh.shape) shapes[mesh.file] = mesh.shape;
  });
  for (const Collider& collider : scene.colliders)
    if (const auto* body = std::get_if<MeshBody>(&collider.shape); body && body->motion)
      motions[collider.animation] = body->motion;
}

void MeshStore::give(Scene& scene) const {
  for_each_mesh(scene, [&](auto& mesh, const std::string&) {
    if (const auto known = shapes.find(mesh.file); known != shapes.end() && !mesh.shape)
      mesh.shape = known->second;
  });
  for (Collider& collider : scene.colliders) {
    MeshBody* body = std::get_if<MeshBody>(&collider.shape);
    if (!body || body->motion) continue;
    if (const auto known = motions.find(collider.animation); known != motions.end())
      body->motion = known->second;
  }
}

}  // namespace weft
