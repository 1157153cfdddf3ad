// A balloon between two planes that approach, against closed forms: the work that the planes do is the force of the gas
// on what touches them, p A; the gas keeps its law; nothing comes through.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "made_up_balloon.h"
#include "made_up_mesh.h"
#include "weft/simulation.h"
#include "weft/vec3.h"

namespace weft {
namespace {

constexpr double kRadius = 0.2, kOffset = 0.001;  // m
constexpr double kSettle = 0.25, kMove = 0.1;     // s

struct Press {
  const char* name;
  Method method;
  Sweep sweep;
  Pressure pressure;
};

// The gap goes down in steps, after each of which the balloon comes to rest.
Scene press_of(const Press& press, const std::vector<double>& gaps) {
  Scene scene;
  scene.gravity = {};
  scene.solver.method = press.method;
  scene.solver.sweep = press.sweep;
  // Methods that project meet the planes after the gas, which has moved what touches by p dt²/ρ: 0.07 mm.
  if (press.method == Method::compliant) scene.time.substeps = 100;
  scene.solver.iterations = press.method == Method::compliant ? 2 : 1;
  Cloth& cloth = scene.cloths.emplace_back();
  cloth.mesh.shape = made_up_balloon(4, kRadius);
  cloth.density = 0.5;
  cloth.membrane = {600, 600, 180, 210, 0};
  cloth.drag = 25;
  cloth.pressure = press.pressure;
  for (const double side : {-1.0, 1.0}) {
    Collider plane;
    plane.shape = Plane{{0, side * 0.3, 0}, {0, -side, 0}};
    plane.offset = kOffset;
    plane.keys = {{0, {0, side * 0.3, 0}}};
    double time = 0;
    for (const double gap : gaps) {
      const Vec3 at{0, side * (gap / 2 + kOffset), 0};
      plane.keys.push_back({time + kMove, at});
      plane.keys.push_back({time + kMove + kSettle, at});
      time += kMove + kSettle;
    }
    scene.colliders.push_back(plane);
  }
  return scene;
}

// Of what lies on the upper plane: by its farthest points all around.
double touching_area(const std::vector<double>& x, double gap) {
  constexpr std::size_t kSectors = 16;
  std::array<double, kSectors> farthest{};
  for (std::size_t n = 0; n < x.size(); n += 3) {
    if (x[n + 1] < gap / 2 - 1e-5) continue;
    const double angle = std::atan2(x[n + 2], x[n]) / (2 * M_PI) + 0.5;
    double& most = farthest[std::min(std::size_t(angle * kSectors), kSectors - 1)];
    most = std::max(most, std::hypot(x[n], x[n + 2]));
  }
  double area = 0;
  for (const double r : farthest) area += M_PI * r * r / kSectors;
  return area;
}

TEST(MeshPress, PlanesDoTheWorkOfThePressureOnWhatTouches) {
  const std::vector<double> gaps{0.304, 0.296, 0.204, 0.196};
  for (const Press& press :
       {Press{"spring, ideal",
              Method::spring,
              Sweep::gauss_seidel,
              {.inflate = 1.15, .ambient = 9000}},
        Press{"spring, constant", Method::spring, Sweep::gauss_seidel, {.over = 600}},
        Press{"compliant, ideal",
              Method::compliant,
              Sweep::gauss_seidel,
              {.inflate = 1.15, .ambient = 9000}},
        Press{
            "lines, ideal", Method::compliant, Sweep::line, {.inflate = 1.15, .ambient = 9000}}}) {
    const Scene scene = press_of(press, gaps);
    const Cloth& cloth = scene.cloths[0];
    Simulation run(scene, {.threads = 1});
    double energy = 0, force = 0;
    for (std::size_t n = 0; n < gaps.size(); ++n) {
      while (run.time() < double(n + 1) * (kMove + kSettle) - 1e-9) {
        run.advance_frame();
        double gap = 0;  // now
        for (const Collider& c : scene.colliders)
          gap += std::abs(position_at(c.keys, run.time())[1]) - kOffset;
        const std::vector<double> x = run.positions();
        for (std::size_t p = 1; p < x.size(); p += 3)
          ASSERT_LT(std::abs(x[p]), gap / 2 + 1e-6) << press.name << " at " << run.time() << " s";
      }
      ASSERT_TRUE(run.status().ok);
      const std::vector<double> x = run.positions();
      const double volume = enclosed(x, *cloth.mesh.shape);
      const bool ideal = cloth.pressure.inflate > 0;
      const double over =
          ideal ? 9000 * (1.15 * enclosed_volume(cloth) / volume - 1) : cloth.pressure.over;
      const double now = over * touching_area(x, gaps[n]), held = run.report().energy.elastic;
      std::printf("%s: gap %.2f m, volume %.5f m³, over %.0f Pa, pA %.2f N, energy %.4f J",
                  press.name, gaps[n], volume, over, now, held);
      if (n % 2 == 1) {
        const double work = (held - energy) / (gaps[n - 1] - gaps[n]), mean = (now + force) / 2;
        std::printf(", work %.2f N, mean pA %.2f N", work, mean);
        EXPECT_NEAR(work, mean, 0.05 * mean) << press.name << ", gap " << gaps[n];
      }
      std::printf("\n");
      energy = held;
      force = now;
    }
  }
}

}  // namespace
}  // namespace weft
