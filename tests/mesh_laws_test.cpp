// Cloth of triangle meshes against its truths: forces against the energy, kernels against double precision,
// laws of motion, strips and plates in a wind against their closed form.
#include <gtest/gtest.h>

#include "mesh_scenes.h"
#include "physics/model/mesh/rest_triangles.h"
#include "truth.h"
#include "weft/vec3.h"

namespace weft {
namespace {

TEST(MeshCloth, ForcesAreTheSlopeOfTheEnergy) {
  const auto mesh = made_up({.nx = 5, .ny = 4, .shift = 0.3});
  for (const Material& material : kMaterials) {
    Scene scene = scene_of(mesh);
    material.set(scene);
    const auto triangles =
        physics::rest_triangles(*mesh, {mesh->vertices}, scene.cloths[0].bending);
    const auto made_of = physics::material_of(scene.cloths[0], false);
    std::vector<Vec3> x = rumpled(*mesh, 0.05, 3), force(x.size());
    physics::add_mesh_forces(triangles, made_of, x, nullptr, force);
    for (std::size_t p = 0; p < x.size(); ++p)
      for (std::size_t k = 0; k < 3; ++k) {
        const double slope = energy_slope(triangles, made_of, x, p, k);
        EXPECT_NEAR(force[p][k], slope, 1e-5 * (1 + std::abs(force[p][k])))
            << material.name << ", particle " << p;
      }
  }
}

// One frame of few substeps by kernels, beside plain leapfrog in double precision.
TEST(MeshCloth, KernelsDoWhatTheEquationsSay) {
  const auto mesh = made_up({.nx = 23, .ny = 17, .shift = 0.3, .shuffled = true});
  for (const Material& material : kMaterials) {
    Scene scene = scene_of(mesh);
    material.set(scene);
    scene.time = {2e-4, 8, 1};
    scene.cloths[0].drag = 0.5;
    scene.cloths[0].pins = {{5, 0, {}}, {100, 0, {}}};
    const Cloth& cloth = scene.cloths[0];
    const std::vector<Vec3> start = rumpled(*mesh, 0.004, 7);
    std::vector<double> flat;
    for (const Vec3& p : start) flat.insert(flat.end(), p.begin(), p.end());
    Simulation run(scene, {.threads = 1});
    run.set_state(flat, std::vector<double>(flat.size()));
    const auto rounded = positions_of(run);
    run.advance_frame();

    const auto triangles = physics::rest_triangles(*mesh, {mesh->vertices}, cloth.bending);
    const auto made_of =
        physics::material_of(cloth, scene.solver.method == Method::spring_friction);
    std::vector<double> masses(start.size());
    for (const auto& r : triangles)
      for (std::size_t k = 0; k < 3; ++k)
        masses[std::size_t(r.corner[k])] += cloth.density * r.area / 3;
    std::vector<Vec3> x = rounded, v(x.size());
    const double dt = run.dt();
    const auto accelerations = [&](const std::vector<Vec3>* velocities) {
      std::vector<Vec3> a(x.size());
      physics::add_mesh_forces(triangles, made_of, x, velocities, a);
      for (std::size_t p = 0; p < x.size(); ++p)
        a[p] = p == 5 || p == 100 ? Vec3{} : plus(times(a[p], 1 / masses[p]), scene.gravity);
      return a;
    };
    // From half a substep before the start.
    const std::vector<Vec3> first = accelerations(nullptr);
    for (std::size_t p = 0; p < x.size(); ++p) v[p] = times(first[p], -dt / 2);
    for (int n = 0; n < run.substeps(); ++n) {
      const std::vector<Vec3> a = accelerations(&v);
      for (std::size_t p = 0; p < x.size(); ++p) {
        v[p] = plus(times(v[p], 1 - dt * cloth.drag), times(a[p], dt));
        x[p] = plus(x[p], times(v[p], dt));
      }
    }
    const auto moved = positions_of(run);
    double greatest = 0, off = 0;
    for (std::size_t p = 0; p < x.size(); ++p) {
      const Vec3 way = minus(x[p], rounded[p]), error = minus(moved[p], x[p]);
      greatest = std::max(greatest, dot(way, way));
      off = std::max(off, dot(error, error));
    }
    EXPECT_GT(std::sqrt(greatest), 1e-5) << material.name;
    EXPECT_LT(std::sqrt(off), 5e-7 + 2e-3 * std::sqrt(greatest)) << material.name;
  }
}

// Without gravity a rumpled sheet keeps momentum, angular momentum and energy.
TEST(MeshCloth, KeepsMomentumAndEnergy) {
  const auto mesh = made_up({.nx = 15, .ny = 13, .shift = 0.3});
  for (const Material& material : kMaterials) {
    Scene scene = scene_of(mesh);
    material.set(scene);
    scene.gravity = {};
    scene.time.substeps = 600;  // far within the limit: what is told swings with its square
    scene.cloths[0].velocity = {0.3, 0.1, -0.2};
    scene.cloths[0].spin = {0.5, 1, 0.2};
    Simulation run(scene, {.threads = 1});
    std::vector<double> flat;
    for (const Vec3& p : rumpled(*mesh, 0.005, 5)) flat.insert(flat.end(), p.begin(), p.end());
    const std::vector<double> v = run.velocities();
    run.set_state(flat, v);
    const Report before = run.report();
    for (int n = 0; n < 10; ++n) run.advance_frame();
    const Report after = run.report();
    const bool damped = std::string(material.name).find("damped") == 0;
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(after.momentum[k], before.momentum[k], 2e-5) << material.name;
      EXPECT_NEAR(after.angular_momentum[k], before.angular_momentum[k], 2e-5) << material.name;
    }
    if (damped)
      EXPECT_LT(after.energy.total, before.energy.total) << material.name;
    else
      EXPECT_NEAR(after.energy.total, before.energy.total, 0.02 * before.energy.total)
          << material.name;
  }
}

TEST(MeshCloth, FallsAndWeighsWhatItsAreaDoes) {
  Scene scene = scene_of(made_up({.nx = 12, .ny = 9, .width = 2, .height = 0.5, .shift = 0.3}));
  Simulation run(scene, {.threads = 1});
  for (int n = 0; n < 30; ++n) run.advance_frame();
  const Report report = run.report();
  EXPECT_NEAR(report.momentum[1], -0.3 * 9.81 * 0.5, 1e-4);
  EXPECT_NEAR(report.energy.kinetic, 0.5 * 0.3 * std::pow(9.81 * 0.5, 2), 1e-3);
  EXPECT_LT(report.strain.max, 1e-4);
}

// A strip that hangs by its side is stretched by what is below, whatever its triangles.
TEST(MeshCloth, StretchesAsTheContinuumDoes) {
  for (const double shift : {0.0, 0.3}) {
    const auto mesh = made_up({.nx = 9, .ny = 25, .width = 0.3, .height = 1, .shift = shift});
    Scene scene = scene_of(mesh);
    Cloth& cloth = scene.cloths[0];
    cloth.membrane = {400, 250, 0, 100, 2e-3};
    cloth.drag = 3;
    scene.gravity = {0, 0, 9.81};
    for (std::size_t n = 0; n < mesh->vertices.size(); ++n)
      if (mesh->vertices[n][2] == 0) cloth.pins.push_back({int(n), 0, {}});
    Simulation run(scene, {.threads = 1});
    for (int n = 0; n < 300; ++n) run.advance_frame();
    double end = 0;
    const auto x = positions_of(run);
    for (std::size_t n = 0; n < x.size(); ++n)
      if (mesh->vertices[n][2] == 1) end += x[n][2] / 9;
    expect({"hanging strip of a mesh, length",
            shift > 0 ? "irregular triangles" : "regular triangles", hung_length(125), 2e-4, "m"},
           end);
  }
}

// Turned round and mirrored, it moves the same way to rounding: no order of vertices or triangles shows.
TEST(MeshCloth, DoesNotSeeTheOrderOfItsVertices) {
  const MadeUpMesh plain{.nx = 13, .ny = 13, .shift = 0.2};
  std::vector<Vec3> at[2];
  for (const bool shuffled : {false, true}) {
    MadeUpMesh like = plain;
    // Shuffling draws from the same source: shifts are drawn anew, so a plain mesh is renumbered here.
    const auto mesh = made_up(like);
    const auto count = int(mesh->vertices.size());
    const auto renamed = [&](int n) { return shuffled ? (n * 29 + 11) % count : n; };
    auto other = std::make_shared<TriangleMesh>(*mesh);
    for (int n = 0; n < count; ++n)
      other->vertices[std::size_t(renamed(n))] = mesh->vertices[std::size_t(n)];
    for (auto& t : other->triangles)
      for (int& corner : t) corner = renamed(corner);
    Scene scene = scene_of(other);
    scene.cloths[0].membrane = kCanvas;
    scene.cloths[0].bending = 1e-4;
    scene.cloths[0].drag = 1;
    for (int n = 0; n < 13; ++n) scene.cloths[0].pins.push_back({renamed(13 * n), 0, {}});
    Simulation run(scene, {.threads = 1});
    for (int n = 0; n < 15; ++n) run.advance_frame();
    const auto x = positions_of(run);
    for (int n = 0; n < count; ++n) at[shuffled].push_back(x[std::size_t(renamed(n))]);
  }
  for (std::size_t n = 0; n < at[0].size(); ++n)
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(at[0][n][k], at[1][n][k], 2e-5);
}

// What a flat mesh in a wind at an angle gains is what a flat plate does, whatever its triangles.
TEST(MeshCloth, IsPushedByWindAsAFlatPlate) {
  Scene scene = scene_of(made_up({.nx = 14, .ny = 11, .shift = 0.3, .shuffled = true}));
  scene.gravity = {};
  scene.time = {1e-3, 1, 1};
  scene.cloths[0].membrane = {10, 10, 0, 5, 0};
  scene.wind = {{3, 4, 0}, 0.6, 0.3, 0};
  Simulation run(scene, {.threads = 1});
  run.advance_frame();
  const Report report = run.report();
  // n = y: drag 0.6 · 4² along n; lift 0.3 · 4 · 5 (n - û 4/5). The cloth, 0.3 kg/m², gives way within the
  // substep: the impulse is dt F / (1 + a + b²), a = dt 0.6 · 4 / 0.3, b = dt 0.3 · 5 / 0.3.
  const double impulse = 1e-3 / (1 + 8e-3 + 25e-6);
  EXPECT_NEAR(report.momentum[0], impulse * 6 * -0.6 * 0.8, 1e-6);
  EXPECT_NEAR(report.momentum[1], impulse * (9.6 + 6 * (1 - 0.64)), 1e-6);
  EXPECT_NEAR(report.momentum[2], 0, 1e-6);
}

}  // namespace
}  // namespace weft
