// Course scenes against the course's simulator in double precision (course_solver.h): the same file for
// both, position for position. Self-collision and the strain limit are off where the file says nothing else.
#include "course_solver.h"
#include "truth.h"
#include "weft/read_scene.h"
#include "weft/simulation.h"

namespace weft {
namespace {

using course::operator-;

// Greatest distance between the two after so many seconds [m]. What is random at the start of a vertical
// sheet is Weft's. Where a sheet that is pressed together in its plane begins to fold, rounding decides to
// which side, and a particle that meets a plane does so a step earlier or later: from then on both are right.
double distance_after(const course::File& file, double seconds, int threads) {
  const SceneFile read =
      read_scene_text(course::text_of(file),
                      {{"/cloths/0/strain_limit", file.limited ? "0.1" : "0"},
                       {"/cloths/0/strain_limit_order", "course"},
                       {"/cloths/0/self_collision/mode", file.neighbours ? "particles" : "off"}});
  EXPECT_TRUE(read.faults.empty());
  Simulation simulation(read.scene, {.threads = threads});
  course::Solver truth(file);
  const std::vector<double> start = simulation.positions();
  for (std::size_t p = 0; p < truth.points.size(); ++p)
    truth.points[p].position =
        truth.points[p].last_position = {start[3 * p], start[3 * p + 1], start[3 * p + 2]};
  const int frames = int(std::lround(90 * seconds));
  for (int f = 0; f < frames; ++f) {
    simulation.advance_frame();
    truth.advance_frame();
  }
  EXPECT_EQ(simulation.substeps(), 30);
  double most = 0;
  const std::vector<double> x = simulation.positions();
  for (std::size_t p = 0; p < truth.points.size(); ++p)
    most = std::max(most, course::length(truth.points[p].position -
                                         course::Vec{x[3 * p], x[3 * p + 1], x[3 * p + 2]}));
  return most;
}

course::File hung(int columns, int rows, double ks, double density, double damping) {
  course::File file;
  file.columns = columns;
  file.rows = rows;
  file.ks = ks;
  file.density = density;
  file.damping = damping;
  file.pinned = {{0, 0}, {columns - 1, 0}};
  return file;
}

TEST(Course, SpringsDampingAndPinsAreTheCoursesForFiveSeconds) {
  const auto row = [](const std::string& what, const course::File& file, int threads) {
    expect({"course scene against the course's solver", what + ", after 5 s", 0, 1e-4, "m"},
           distance_after(file, 5, threads));
  };
  row("25 x 25 pinned by two corners", hung(25, 25, 5000, 150, 0.2), 2);
  row("17 x 29, ks 1000, density 300, damping 0.9", hung(17, 29, 1000, 300, 0.9), 1);
  row("20 x 20, ks 20000, density 1000, damping 0.1", hung(20, 20, 20000, 1000, 0.1), 3);
  course::File four = hung(24, 18, 5000, 150, 0.3);
  four.width = 1.3;
  four.pinned = {{0, 0}, {23, 0}, {0, 17}, {23, 17}, {11, 8}};
  row("24 x 18 over 1.3 m pinned by four corners and the middle", four, 2);
  course::File vertical = hung(20, 20, 5000, 150, 0.5);
  vertical.vertical = true;
  vertical.pinned = {{0, 19}, {19, 19}};
  row("20 x 20 vertical, pinned above", vertical, 1);
  course::File threads = hung(21, 21, 5000, 150, 0.2);
  threads.bending = false;
  row("21 x 21 without bending springs", threads, 2);
}

TEST(Course, APlaneAndASphereAreTheCoursesUntilTheFirstFold) {
  const auto row = [](const std::string& what, const course::File& file, double seconds,
                      int threads) {
    expect({"course scene against the course's solver", what, 0, 1e-3, "m"},
           distance_after(file, seconds, threads));
  };
  course::File plane;
  plane.plane = true;
  row("a sheet falls flat on the plane, 2 s", plane, 2, 2);
  plane.normal = {0.3, 2, 0.1};  // not a unit vector
  plane.plane_friction = 0.2;
  row("its edge meets a tilted plane, 0.74 s", plane, 0.74, 1);
  course::File sphere;
  sphere.sphere = true;
  for (const double ks : {500.0, 5000.0, 50000.0}) {
    sphere.ks = ks;
    row("on the sphere, ks " + std::to_string(int(ks)) + ", 0.6 s", sphere, 0.6, 2);
  }
  sphere.ks = 5000;
  sphere.plane = true;
  sphere.sphere_friction = 0.05;
  sphere.damping = 0.05;
  row("on a smoother sphere over a plane, 0.5 s", sphere, 0.5, 3);
}

TEST(Course, TheStrainLimitIsTheCourses) {
  const auto row = [](const std::string& what, course::File file, double seconds, int threads) {
    file.limited = true;
    expect({"strain limit in the course's order against its solver", what, 0, 1e-3, "m"},
           distance_after(file, seconds, threads));
  };
  row("25 x 25 pinned by two corners, 5 s", hung(25, 25, 5000, 150, 0.2), 5, 2);
  row("17 x 29, ks 1000, density 300, damping 0.9, 5 s", hung(17, 29, 1000, 300, 0.9), 5, 1);
  row("20 x 20, ks 500, density 1000, damping 0.5, 5 s", hung(20, 20, 500, 1000, 0.5), 5, 3);
  course::File four = hung(24, 18, 1000, 150, 0.3);
  four.width = 1.3;
  four.pinned = {{0, 0}, {23, 0}, {0, 17}, {23, 17}, {11, 8}};
  row("24 x 18 over 1.3 m pinned by four corners and the middle, 5 s", four, 5, 2);
  course::File vertical = hung(20, 20, 500, 150, 0.5);
  vertical.vertical = true;
  vertical.pinned = {{0, 19}, {19, 19}};
  row("20 x 20 vertical, pinned above, 5 s", vertical, 5, 1);
  course::File structural = hung(21, 21, 2000, 150, 0.2);
  structural.shearing = structural.bending = false;
  row("21 x 21 structural springs alone, 5 s", structural, 5, 2);
  course::File sphere = hung(25, 25, 500, 150, 0.2);
  sphere.sphere = true;
  row("25 x 25 pinned by two corners over a sphere, 0.5 s", sphere, 0.5, 3);
}

// As by the course's self-collision, which other layers take no part in before any touch.
TEST(Course, NeighboursPushEachOtherApartAsInTheCourse) {
  const auto row = [](const std::string& what, course::File file, double seconds, int threads) {
    file.neighbours = true;
    expect({"neighbours pressed together against the course's solver", what, 0, 1e-4, "m"},
           distance_after(file, seconds, threads));
  };
  course::File file = hung(25, 25, 5000, 150, 0.2);
  file.thickness = 0.0195;  // 39 mm apart at a spacing of 40 mm
  row("25 x 25 pinned by two corners, 1 s", file, 1, 2);
  file.pinned = {{0, 0}, {24, 0}, {0, 24}, {24, 24}};
  row("25 x 25 pinned by four corners, 5 s", file, 5, 1);
  file.limited = true;
  row("the same with the strain limit, 5 s", file, 5, 3);
  file.pinned = {{0, 0}, {24, 0}};
  file.sphere = true;
  row("pinned by two corners over a sphere, with the strain limit, 0.5 s", file, 0.5, 2);
}

struct Held {
  double greatest = 0, at_end = 0;  // strain
};

// Greatest strain of structural and shear springs.
double greatest_strain(const Simulation& simulation, const Grid& g) {
  const std::vector<double> x = simulation.positions();
  double most = 0;
  for (int j = 0; j < g.ny; ++j)
    for (int i = 0; i < g.nx; ++i)
      for (const auto& [di, dj] : {std::array{1, 0}, {0, 1}, {1, 1}, {-1, 1}}) {
        if (i + di < 0 || i + di >= g.nx || j + dj >= g.ny) continue;
        const double *a = &x[3 * std::size_t(j * g.nx + i)],
                     *b = &x[3 * std::size_t((j + dj) * g.nx + i + di)];
        const double rest = std::hypot(di * spacing_u(g), dj * spacing_v(g));
        most = std::max(most, std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]) / rest - 1);
      }
  return most;
}

Held strains(const SceneFile& file, double seconds, int threads) {
  EXPECT_TRUE(file.faults.empty());
  Simulation simulation(file.scene, {.threads = threads});
  Held held;
  for (int f = 0; f < int(std::lround(90 * seconds)); ++f) {
    simulation.advance_frame();
    held.at_end = greatest_strain(simulation, file.scene.cloths[0].grid);
    held.greatest = std::max(held.greatest, held.at_end);
  }
  EXPECT_EQ(simulation.substeps(), 30);
  return held;
}

// In motion a sudden load may take a share more of the limit before the forces have met it.
TEST(Course, ScenesHoldTheStrainLimit) {
  const auto row = [](const std::string& scene, const std::string& ks, double seconds,
                      int threads) {
    for (const char* response : {"course", "stiff"}) {
      const SceneFile file =
          read_scene(scene, {{"/cloth/ks", ks}, {"/cloths/0/self_collision/response", response}});
      const Held held = strains(file, seconds, threads);
      const std::string what = scene + ", ks " + ks + ", response " + response;
      const char* const law = "strain limit of course scenes";
      expect({law, what + ", greatest at any frame's end", 0, 0.103, "1"}, held.greatest);
      expect({law, what + ", at the end", 0, 0.1005, "1"}, held.at_end);
    }
  };
  row("pinned2", "500", 2, 1);
  row("pinned2", "5000", 3, 2);
  row("pinned4", "5000", 2, 3);
  row("sphere", "5000", 3, 1);
}

// The truth is the course's solver with so many passes that its limit holds.
TEST(Course, AHeldLimitMovesAsManyPassesDo) {
  for (const double ks : {500.0, 5000.0}) {
    course::File file = hung(25, 25, ks, 150, 0.2);
    file.limited = true;
    file.limits_bending = false;
    file.limit_passes = 40;
    const SceneFile read =
        read_scene_text(course::text_of(file), {{"/cloths/0/self_collision/mode", "off"}});
    ASSERT_TRUE(read.faults.empty());
    Simulation simulation(read.scene, {.threads = 2});
    course::Solver truth(file);
    double most = 0;
    for (int f = 0; f < 180; ++f) {
      simulation.advance_frame();
      truth.advance_frame();
      const std::vector<double> x = simulation.positions();
      double square = 0;
      for (std::size_t p = 0; p < truth.points.size(); ++p) {
        const course::Vec off =
            truth.points[p].position - course::Vec{x[3 * p], x[3 * p + 1], x[3 * p + 2]};
        square += course::dot(off, off);
      }
      most = std::max(most, std::sqrt(square / double(truth.points.size())));
    }
    expect({"a held strain limit against the course's solver with 40 passes",
            "25 x 25 pinned by two corners, ks " + std::to_string(int(ks)) +
                ", greatest RMS distance within 2 s",
            0, 0.01, "m"},
           most);
  }
}

// The first step from rest adds a whole step's acceleration: x = x0 + g dt².
TEST(Course, BeginsWithAWholeKick) {
  const SceneFile read = read_scene_text(R"({"cloth": {"num_width_points": 8,
    "num_height_points": 8, "ks": 0, "damping": 0}})");
  ASSERT_TRUE(read.faults.empty());
  Scene scene = read.scene;
  EXPECT_TRUE(scene.solver.full_first_kick);
  scene.time = {0.1, 1, 1};
  Simulation whole(scene);
  whole.advance_frame();
  EXPECT_NEAR(whole.positions()[1], 1 - 9.8 * 0.01, 1e-6);
  scene.solver.full_first_kick = false;
  Simulation half(scene);
  half.advance_frame();
  EXPECT_NEAR(half.positions()[1], 1 - 9.8 * 0.005, 1e-6);
}

}  // namespace
}  // namespace weft
