// The parts of random scenes.
#pragma once

#include <string>

#include "draw.h"

namespace fuzz {

// Where a cloth lies as it begins.
struct Extent {
  weft::Vec3 corner{}, middle{};  // m
  double size = 0, spacing = 0;   // m
};
Extent extent_of(const weft::Grid& grid);
Extent extent(const weft::Cloth& cloth);

constexpr double kFarthest = 10000;  // m, of any coordinate of a scene

double length(const weft::Vec3& a);
// a + times b, no farther away than kFarthest.
weft::Vec3 plus(const weft::Vec3& a, const weft::Vec3& b, double times = 1);

// Draws the parts of one scene. A scene is plain or rich in features, so that some have one alone and
// others have many together.
class Parts {
 public:
  explicit Parts(Draw& draw);

  weft::Time time();
  weft::Solver solver();
  weft::Cloth cloth(const weft::Solver& solver, const weft::Time& time);
  // A cloth that lies a few thicknesses from another, or through it.
  weft::Cloth layer(const weft::Cloth& below);
  // Near the cloth.
  weft::Collider collider(const weft::Cloth& cloth, const weft::Time& time);
  weft::Wind wind();
  weft::Vec3 gravity();
  // Values over time, motion at the start, and what the seeds do another way.
  void add_motion(weft::Scene& scene);
  // Some cloths become triangles, and some bodies; the files are cloth0.obj, body0.obj and so on. What
  // meshes do not have goes.
  void add_meshes(weft::Scene& scene);
  // One of the cloths becomes a closed mesh with a gas in it, where it may.
  void add_gas(weft::Scene& scene);

  // Some meshes can tear, and some colliders cut.
  void tear_meshes(weft::Scene& scene);

  // Some optional feature, more often in rich scenes.
  bool some(double share) { return draw_.chance(share * richness_); }
  // Some that stand still become one pin of several; others hold what starts within a box.
  void gather_pins(weft::Scene& scene);
  std::vector<weft::Pin> pins(const weft::Cloth& cloth, const weft::Time& time);
  double stiffness();

 private:
  std::vector<weft::Pin> grid_pins(const weft::Grid& grid, const weft::Time& time);
  std::vector<weft::Pin> vertex_pins(const weft::Cloth& cloth, const weft::Time& time);
  void make_mesh(weft::Cloth& cloth, const std::string& file);
  void sew(weft::Cloth& cloth);
  weft::MeshBody body(const weft::Vec3& at, double size, const std::string& file);
  weft::Grid grid();
  void points(weft::Grid& grid);
  void sides(weft::Grid& grid);
  void masses(weft::Cloth& cloth);
  void make_membrane(weft::Cloth& cloth, const weft::Solver& solver);
  void limits(weft::Cloth& cloth);
  std::vector<weft::CutLine> cuts(const weft::Grid& grid);
  weft::SelfCollision self_collision(const weft::Grid& grid);
  weft::Shape shape(const weft::Vec3& at, double size);
  weft::Friction friction();
  std::vector<weft::Key> path(const weft::Vec3& start, double size, double frame);
  weft::Rotation rotation(const weft::Vec3& near, double size, double frame);

  Draw& draw_;
  double richness_;
  double spacing_;      // m, of the grids
  weft::Vec3 place_{};  // m, where the scene lies
};

}  // namespace fuzz
