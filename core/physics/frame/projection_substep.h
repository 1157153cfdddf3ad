// How long substeps of methods that project may be, and what of their settings is stable.
#pragma once

#include <string>

#include "weft/scene.h"

namespace weft::physics {

// s, of methods that project; about what a sheet of 1 m with 32 x 32 points needs.
inline constexpr double kLongestProjection = 1.0 / 960;

// Methods that project are stable at any substep, but a sweep of Gauss-Seidel or Jacobi passes a pull on
// over one constraint alone: each is as stiff as a substep can make it, m/(2 dt²), and a sheet of n
// points, h apart, that hangs by its edge stretches there by 2 n g dt²/h. A gas of pressure p in a mesh of
// density ρ stretches it as such a pull of g = p/ρ does. The longest substep that keeps this to 2 %, or lets one
// sweep do all that the material's own stiffness asks for, k dt² = m; at most kLongestProjection. A gas holds all of a
// cloth stretched, and what sweeps leave of that is energy: they are to be within a twentieth of it, k dt² = m/10.
//
// Line sweeps pass a pull on along a whole line, but from line to line as the others do. Where n points hang by few, P,
// each of these bears g n/P as many particles: substeps are so short that this moves one by 0.12 spacings. (Sheets of
// 32 to 100 points a side by a corner, two, four, or the middle; strain within 1.2 of springs', or told.)
double projection_substep(const Scene& scene);

// How many times as much as its stiffness says a cloth stretches that hangs by its pins or holds a gas, in substeps of
// dt of compliant Gauss-Seidel or Jacobi sweeps without tethers: about 1 + 0.7 (k dt²/m)^0.8, of sheets of 32 x 32 points
// held by corners, an edge and a point, 1e3 and 1e4 N/m, for each sweep 0.2 to 40: 1.2 to 17 times, within a third.
// Balloons of 642 vertices, both orders: the same for 1, a third less of it for 0.2. 1 of others.
double overstretch(const Scene& scene, const Cloth& cloth, Method method, double dt);
// s; in which that is so much, above 1.
double substep_of_overstretch(const Scene& scene, const Cloth& cloth, double times);

// How much less a gas pushes than its volume says, a share of its pressure over that of the air: methods that project
// solve for the volume as if the cloth went where the gas pushes it, and what sweeps and bodies put back makes it
// smaller again. A pressure p within a surface A of mass density ρ about a volume V falls short by a/(1 + a),
// a = dt² p A/(ρ V). 0 of a constant pressure.
double gas_shortfall(const Cloth& cloth, double dt);
// s; in which that is so much, below 1; infinite of what has none.
double substep_of_shortfall(const Cloth& cloth, double shortfall);

// The longest substep in which sweeps that project spread strain as the material does, so that the cloth tears where
// its tear_strain says, to a fifth or nearer. 0: none, for constraints are rigid. Infinite: it cannot tear, or tears
// as seed 000 does; or it is held by springs that are solved one by one, which are measured in the midst of their sweep
// (kernels/gauss_seidel.cpp, mesh_sweeps.cpp).
double tearing_substep(const Scene& scene, const Cloth& cloth, Method method);

// How far a cloth may be drawn out along its lines before line sweeps in substeps of dt shake it. A line is solved as
// a whole along the directions that its constraints begin the sweep with, so that their pull T across the line acts as
// an explicit spring: T dt²/(m h), with m of a particle and h between two, is to stay below about 2 for each sweep,
// 0.7 on a mesh.
struct Shaking {
  double strain =
      0;  // from there on; infinite: other sweeps, which turn one constraint after the other, or methods
  double spread = 0;  // of one constraint in its line, over so many (model/strain_in_line.h)
};
Shaking shaking(const Scene& scene, const Cloth& cloth, Method method, double dt);

// Jacobi adds up corrections that each constraint works out for two ends of like mass; where a light
// particle has heavy neighbours they add up to more than the whole. And a single sweep with compliance
// is an explicit spring as stiff as the sweep allows, which large motions feed: two sweeps damp. Puts
// what is stable into the scene and returns what to tell, "" where nothing changed.
std::string steady_jacobi(Scene& scene);

}  // namespace weft::physics
