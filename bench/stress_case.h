// One run of the stability stress: a scene, how its sheet lies at the start, and what becomes of it.
//
// A run is bounded while its kinetic and elastic energy stay within what was put in: the elastic
// energy of the start, the start's motion, and what gravity has released. A projected constraint
// counts as a spring of at most the inertia of its ends over dt², which is all that a sweep makes of
// it, and of its positional share; bending counts in full where it is put in, and later as much as a
// projection of it feels at least. Leapfrog at 0.9 of the stability limit swings by 1/(1 - 0.9²) =
// 5 about its energy, so that kBound leaves three times that; what explodes passes it by many
// decades.
#pragma once

#include <cstdint>
#include <string>

#include "weft/scene.h"

namespace bench {

inline constexpr double kBound = 15;  // times the energy put in

// How the sheet lies when the run begins: as the grid says; folded in half; through the middle of a
// ball; all particles in one point; stretched and jittered, and so weak that it tears at once.
enum class Start { flat, folded, inside, coincident, shreds };
inline constexpr Start kStarts[] = {Start::flat, Start::folded, Start::inside, Start::coincident,
                                    Start::shreds};
const char* start_name(Start start);

struct StressCase {
  weft::Scene scene;
  Start start = Start::flat;
  double seconds = 0.5;    // at least; and at least 60 substeps
  double speed = 0;        // m/s; random velocities of the start
  std::uint64_t seed = 1;  // of positions and velocities of the start
};

// What a scene comes to, from best to worst. `saved`: the solver ran another way than the scene asks
// because it would not have been stable.
enum class Fate { stable, saved, refused, unbounded, not_finite };
inline constexpr int kFates = 5;
const char* fate_name(Fate fate);

struct Verdict {
  Fate fate = Fate::stable;
  double energy = 0;  // greatest, in what was put in
  std::string why;    // of refusal or stop
};

// Our own solver.
Verdict run_stress(const StressCase& c);

// The course-style solver, which neither refuses nor saves; `iterations` scales its springs.
Verdict run_course_stress(const StressCase& c);

// A sheet of n x n particles, spacing [m] apart, flat and level, held by its first row when pinned.
weft::Scene stress_sheet(int n, double spacing, double particle_mass, bool pinned);

// The case `number` of the random settings: every value of solver, cloth and start drawn anew, some of
// them out of range together (the scene is then refused).
StressCase random_case(std::uint64_t number);

}  // namespace bench
