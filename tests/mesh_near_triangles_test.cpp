// What is kept of the triangles near to a few points gives the nearest point of the whole surface, bit by bit.
#include <gtest/gtest.h>

#include <random>

#include "made_up_bodies.h"
#include "physics/contact/body/body_surface.h"
#include "physics/contact/body/near_triangles.h"
#include "physics/kernels/kernels.h"

namespace weft {
namespace {

using physics::AlignedBox;
using physics::BodyMoment;
using physics::NearTriangles;

double wavy(double a, double p) {
  return 0.4 + 0.1 * std::sin(3 * a) * std::sin(p);
}

std::shared_ptr<TriangleMesh> stretched(TriangleMesh mesh, const Vec3& by) {
  for (Vec3& p : mesh.vertices)
    for (std::size_t k = 0; k < 3; ++k) p[k] *= by[k];
  return std::make_shared<TriangleMesh>(std::move(mesh));
}

// It turns, is bent and travels; a sample every tenth of a second.
std::shared_ptr<const BodySurface> surface_of(const std::shared_ptr<TriangleMesh>& mesh, bool moves,
                                              double size) {
  if (!moves) return std::make_shared<const BodySurface>(*mesh, mesh->vertices);
  auto cache = std::make_shared<PointCache>();
  cache->points = int(mesh->vertices.size());
  for (int n = 0; n < 4; ++n) {
    cache->times.push_back(0.1f * float(n));
    const double angle = 0.2 * n;
    for (const Vec3& p : mesh->vertices)
      cache->places.push_back(
          {float(std::cos(angle) * p[0] + std::sin(angle) * p[2] + 0.1 * size * n),
           float(p[1] + 0.1 * size * std::sin(4 * p[0] / size + n)),
           float(std::cos(angle) * p[2] - std::sin(angle) * p[0])});
  }
  MeshBody body;
  body.shape = mesh;
  body.file = "body.obj";
  body.motion = std::move(cache);
  return weft::surface_of(body);
}

// About places anywhere, mostly at corners, edges and faces, and at the middle of what is round.
Vec3 some_place(std::mt19937& random, const BodyMoment& body, double size) {
  std::uniform_real_distribution<double> within(-1, 1);
  const auto t = body.corners(int(random() % body.form().triangles.size()));
  const double u = random() % 2 ? 0 : 0.3, v = random() % 2 ? 0 : 0.4;
  Vec3 p;
  for (std::size_t k = 0; k < 3; ++k)
    p[k] = t[0][k] + u * (t[1][k] - t[0][k]) + v * (t[2][k] - t[0][k]);
  const double off = std::array{0.0, 1e-7, 1e-3, 0.02, 0.3}[random() % 5] * size;
  for (double& x : p) x += off * within(random);
  return random() % 20 == 0 ? Vec3{} : p;
}

TEST(TrianglesNear, GiveTheNearestPointOfTheWholeSurface) {
  const auto thin = stretched(*tests::ball(12, 8, 0.4), {1, 0.01, 1e-4});
  const auto twins =
      tests::together(*tests::ball(17, 12, 0.3), *tests::box({0.2, 0.1, 0.3}), {0.25, 0.05, 0});
  const auto nested =
      tests::together(*tests::ball(40, 30, 0.4), *tests::ball(9, 7, 0.1), {0.1, 0, 0});
  NearTriangles::Placed now;
  NearTriangles::Nearest found;
  for (const Simd simd : {Simd::scalar, Simd::best})
    for (const auto& shape : {tests::ball(31, 20, wavy), tests::torus(40, 20, 0.4, 0.1), thin,
                              twins, nested, tests::box({0.3, 0.2, 0.4}), tests::bowl(24, 6, 0.4)})
      for (const double size : {1e-3, 1.0, 1e3})
        for (const bool moves : {false, true}) {
          const auto mesh = stretched(*shape, {size, size, size});
          const auto surface = surface_of(mesh, moves, size);
          const physics::BodyKernels& kernels = physics::kernel_table(simd).bodies;
          std::mt19937 random(3);
          std::uniform_real_distribution<double> within(-1, 1);
          int known = 0, asked = 0;
          for (int n = 0; n < 150; ++n) {
            const double time = 0.05 + 0.125 * (n % 3);
            const BodyMoment body = surface->at(time);
            const Vec3 middle = some_place(random, body, size);
            AlignedBox about;
            about.add(middle);
            about = about.grown(0.05 * size);
            NearTriangles near;
            near.find(body, time, about, (n % 2 ? 0.1 : 0.01) * size,
                      int(random() % mesh->triangles.size()));
            for (const double share : {0.0, 0.3, 1.0}) {
              const double then =
                  moves ? near.along().begin() + share * (near.along().end() - near.along().begin())
                        : time;
              if (std::abs(then) > 1e100) continue;
              const BodyMoment moment = surface->at(then);
              now.done = false;
              for (int m = 0; m < 6; ++m) {
                Vec3 p = middle;
                for (double& x : p) x += (m % 2 ? 0.06 : 0.001) * size * within(random);
                near.nearest(kernels, near.along().seen(p, then), then, now, found);
                const BodyMoment::Point truth = moment.nearest(p);
                ++asked;
                if (surface->form().parts.size() == 1) {
                  ASSERT_LE(found.least, std::abs(truth.distance) * (1 + 1e-9) + 1e-12 * size);
                }
                if (!found.known) continue;
                ++known;
                const BodyMoment::Point point = moment.nearest_among(found.all(), p);
                ASSERT_EQ(point.distance, truth.distance);
                ASSERT_EQ(point.triangle, truth.triangle);
                ASSERT_EQ(point.normal, truth.normal);
                ASSERT_EQ(point.weights, truth.weights);
              }
            }
          }
          EXPECT_GT(known, asked / 20);
        }
}

}  // namespace
}  // namespace weft
