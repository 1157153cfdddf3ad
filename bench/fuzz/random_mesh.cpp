#include "random_mesh.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

#include "weft/point_cache.h"

namespace fuzz {

using namespace weft;

namespace {

// As the reader of files repairs it; null where it refuses.
std::shared_ptr<const TriangleMesh> as_read(const TriangleMesh& mesh) {
  MeshFile file = read_obj(write_obj(mesh), "random.obj");
  if (!file.faults.empty() || file.mesh.triangles.empty()) return nullptr;
  return std::make_shared<const TriangleMesh>(std::move(file.mesh));
}

// Two triangles of every square but those left out, by either diagonal.
void add_triangles(Draw& draw, int nx, int ny, bool tube, double left_out, TriangleMesh& mesh) {
  const int kind = draw.between(0, 2);  // alike, crossed, random
  for (int j = 0; j + 1 < ny; ++j)
    for (int i = 0; i + (tube ? 0 : 1) < nx; ++i) {
      const auto at = [&](int a, int b) { return (j + b) * nx + (i + a) % nx; };
      const int a = at(0, 0), b = at(1, 0), c = at(0, 1), d = at(1, 1);
      const bool one = kind == 0 || (kind == 1 ? (i + j) % 2 == 0 : draw.chance(0.5));
      const bool first = !draw.chance(left_out), second = !draw.chance(left_out);
      if (first) mesh.triangles.push_back(one ? std::array{a, c, b} : std::array{a, d, b});
      if (second) mesh.triangles.push_back(one ? std::array{b, c, d} : std::array{a, c, d});
    }
}

// Vertices in any order; those of no triangle go.
void shuffle(Draw& draw, bool any_order, TriangleMesh& mesh) {
  std::vector<int> order;
  std::set<int> used;
  for (const auto& t : mesh.triangles) used.insert(t.begin(), t.end());
  order.assign(used.begin(), used.end());
  if (any_order)
    for (std::size_t n = order.size(); n > 1; --n)
      std::swap(order[n - 1], order[std::size_t(draw.between(0, int(n) - 1))]);
  std::vector<int> number(mesh.vertices.size(), -1);
  std::vector<Vec3> vertices;
  for (std::size_t n = 0; n < order.size(); ++n) {
    number[std::size_t(order[n])] = int(n);
    vertices.push_back(mesh.vertices[std::size_t(order[n])]);
  }
  mesh.vertices = std::move(vertices);
  for (auto& t : mesh.triangles)
    for (int& corner : t) corner = number[std::size_t(corner)];
}

void add_uv(TriangleMesh& mesh) {
  for (const auto& t : mesh.triangles) {
    auto& uv = mesh.uv.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& p = mesh.vertices[std::size_t(t[k])];
      uv[k] = {p[0] + 0.3 * p[1], p[2] - 0.2 * p[1]};
    }
  }
}

TriangleMesh disc(Draw& draw, int rim) {
  TriangleMesh mesh;
  mesh.vertices.push_back({0.5, 0, 0.5});
  for (int n = 0; n < rim; ++n) {
    const double angle = 2 * std::numbers::pi * (n + draw.uniform(0, 0.5)) / rim;
    mesh.vertices.push_back({0.5 + 0.5 * std::cos(angle), 0, 0.5 + 0.5 * std::sin(angle)});
  }
  for (int n = 0; n < rim; ++n) mesh.triangles.push_back({0, 1 + n, 1 + (n + 1) % rim});
  return mesh;
}

// Every triangle of an octahedron halved along its edges, `times` over, and put on the unit ball.
TriangleMesh ball(int times) {
  TriangleMesh mesh;
  mesh.vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  for (const int x : {0, 1})
    for (const int y : {2, 3})
      for (const int z : {4, 5})
        mesh.triangles.push_back((x + y + z) % 2 == 0 ? std::array{x, y, z} : std::array{x, z, y});
  for (; times > 0; --times) {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [at, fresh] = middles.try_emplace(std::minmax(a, b), int(mesh.vertices.size()));
      if (fresh) {
        Vec3 p;
        for (std::size_t k = 0; k < 3; ++k)
          p[k] = mesh.vertices[std::size_t(a)][k] + mesh.vertices[std::size_t(b)][k];
        const double size = std::hypot(p[0], p[1], p[2]);
        for (double& c : p) c /= size;
        mesh.vertices.push_back(p);
      }
      return at->second;
    };
    std::vector<std::array<int, 3>> finer;
    for (const auto& [a, b, c] : mesh.triangles) {
      const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    mesh.triangles = std::move(finer);
  }
  return mesh;
}

}  // namespace

std::shared_ptr<const TriangleMesh> random_sheet(Draw& draw, int nx, int ny) {
  const double kind = draw.uniform(0, 1);
  TriangleMesh mesh;
  if (kind < 0.1) {
    mesh = disc(draw, std::max(3, std::min(nx + ny, 40)));
  } else {
    const bool tube = kind < 0.2 && nx > 2;
    const double shift = draw.chance(0.3) ? 0 : draw.uniform(0, 0.45), angle = 2 * std::numbers::pi;
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        const double u = (i + shift * draw.uniform(-1, 1)) / (nx - (tube ? 0 : 1));
        const double v = (j + shift * draw.uniform(-1, 1)) / (ny - 1);
        mesh.vertices.push_back(
            tube ? Vec3{std::cos(angle * u) / angle, std::sin(angle * u) / angle, v}
                 : Vec3{u, 0, v});
      }
    add_triangles(draw, nx, ny, tube, draw.chance(0.3) ? draw.uniform(0, 0.3) : 0, mesh);
  }
  if (mesh.triangles.empty()) return nullptr;
  shuffle(draw, draw.chance(0.5), mesh);
  if (draw.chance(0.3)) add_uv(mesh);
  return as_read(mesh);
}

std::shared_ptr<const TriangleMesh> random_body(Draw& draw) {
  if (draw.chance(0.3)) {
    const int nx = draw.between(2, 9);
    return random_sheet(draw, nx, draw.between(2, 9));
  }
  TriangleMesh mesh = ball(draw.between(0, 3));
  const double lumps = draw.chance(0.5) ? 0 : draw.uniform(0, 0.4);
  for (Vec3& p : mesh.vertices) {
    const double size = 1 - lumps * draw.uniform(0, 1);
    for (double& c : p) c *= size;
  }
  return as_read(mesh);
}

std::shared_ptr<const PointCache> random_motion(Draw& draw, const TriangleMesh& mesh,
                                                double frame) {
  auto motion = std::make_shared<PointCache>();
  motion->points = int(mesh.vertices.size());
  const double step = draw.decades(0.2, 20) * frame;
  const double shaken = draw.chance(0.3) ? draw.uniform(0, 0.05) : 0;
  const double angle = draw.uniform(-0.5, 0.5), growth = draw.decades(0.8, 1.25);
  double size = 1, turn = 0;
  Vec3 at{};
  for (int n = draw.between(1, 8), k = 0; k < n; ++k) {
    motion->times.push_back(float(step * (k + 1)));
    const double c = std::cos(turn), s = std::sin(turn);
    for (const Vec3& p : mesh.vertices) {
      const Vec3 q{c * p[0] + s * p[2], p[1], c * p[2] - s * p[0]};
      PointCache::Place& place = motion->places.emplace_back();
      for (std::size_t m = 0; m < 3; ++m)
        place[m] = float(size * q[m] + at[m] + shaken * draw.uniform(-1, 1));
    }
    size *= growth;
    turn += angle;
    for (double& value : at) value += draw.uniform(-0.1, 0.1);
  }
  return motion;
}

void adopt_meshes(Scene& to, const Scene& from) {
  MeshStore read;
  read.take(from);
  read.give(to);
  std::vector<Fault> faults;
  std::vector<std::string> notes;
  load_meshes(to, "", faults, notes);
}

void write_meshes(const Scene& scene, const std::string& folder) {
  for_each_mesh(scene, [&](const auto& mesh, const std::string&) {
    std::ofstream(folder + "/" + mesh.file) << write_obj(*mesh.shape);
  });
  for (const Collider& c : scene.colliders)
    if (const auto* body = std::get_if<MeshBody>(&c.shape); body && body->motion)
      std::ofstream(folder + "/" + c.animation, std::ios::binary) << mdd_bytes(*body->motion);
}

}  // namespace fuzz
