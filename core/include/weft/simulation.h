// Scene -> motion. A Simulation owns the state of one scene and advances it frame by frame:
//
//   weft::Simulation simulation(weft::read_scene("swing").scene);
//   while (simulation.time() < 5) simulation.advance_frame();
//
// The result is the same, bit for bit, for any number of threads and any instruction set.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "weft/report.h"
#include "weft/scene.h"
#include "weft/simd.h"
#include "weft/view.h"

namespace weft {

struct Options {
  int threads = 0;         // worker threads, 0 = all cores, up to 256; never changes the result
  Simd simd = Simd::best;  // never changes the result
  std::uint64_t seed = 1;  // seeds every random choice (jitter, turbulence)
  bool profile = false;    // measure each stage (costs a few percent)
  bool follow_strain =
      false;  // measure the strain after every frame (costs about as much as a sweep)
};

// Thrown by the constructor for a scene that validate() faults.
struct SceneError : std::invalid_argument {
  explicit SceneError(std::vector<Fault> found);
  std::vector<Fault> faults;
};

// All that changes while a simulation runs, kept in memory to go back to. What is told here may be changed; then, and
// in another scene, the run starts anew from it, as after set_state(). Else it goes on to the same bits (`run`).
//
// Particles have numbers 0, 1, 2 … within their cloth, in the order of positions(); of a grid:
// particle_number() (weft/scene.h).
struct Snapshot {
  // How far the deepest particle and triangle of a cloth lay inside a collider when the two met [m], and
  // when that was [s]: for ten frames from then the collider grows to its size.
  struct Inside {
    double time = 0, particle = 0, triangle = 0;
  };
  struct ClothState {
    int columns = 0;  // particles along u of a grid
    // x,y,z per particle: from the origin [m], [m/s]
    std::vector<float> positions, velocities;
    std::vector<int> held;                 // particles that cannot move
    std::vector<std::array<int, 2>> torn;  // constraints that are gone, each by its two particles
    std::vector<Inside> inside;            // of every collider
  };
  double time = 0;  // s
  Vec3 origin{};    // m, what positions are counted from
  double lag = 0;   // s, by which velocities lie behind the positions; 0 to 1
  std::vector<ClothState> cloths;
  std::vector<std::vector<Key>> paths;  // of the colliders
  // What else the next frame depends on, for the scene, seed and version of Weft that it comes from: the past that
  // methods and contact remember, substeps, what guards have seen, hands. Null: begins anew.
  struct Run;
  std::shared_ptr<const Run> run;
  std::size_t bytes() const;
};

class Simulation {
 public:
  // Builds the state and the step plan; where substeps of the scene's method would have to be too short, with
  // another method (Plan::fallback). Throws SceneError when validate(scene) is not empty;
  // std::invalid_argument when options ask for an instruction set this machine lacks.
  explicit Simulation(Scene scene, Options options = {});
  ~Simulation();
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;

  // Advances one frame: `substeps()` substeps of `dt()`. Does nothing once status() is not ok.
  // No allocation after the first frame.
  void advance_frame();

  const Scene& scene()
      const;  // as simulated: plan() notes where its sweep is not the one asked for
  const Options& options() const;
  int threads() const;         // as resolved from the options
  Simd simd() const;           // as resolved from the options
  std::int64_t frame() const;  // frames advanced so far
  double time() const;         // s, frame() * scene().time.frame
  double dt() const;           // s, the substep now in use
  int substeps() const;        // per frame, now in use
  const Plan& plan() const;    // what a frame does, in order, and what it leaves out
  const Status& status() const;

  View view() const;
  // What the arrays of view() lie in. While somebody holds it they stay where they are, whatever becomes
  // of the simulation; set_scene() may go on in other arrays.
  std::shared_ptr<const void> memory() const;

  // Positions of all particles as x,y,z in scene order (row-major j*nx+i, cloth after cloth).
  std::vector<double> positions() const;
  // Velocities at time() in the same order [m/s]; those of methods that project, where the solver is of the
  // first order, are of half a substep before.
  std::vector<double> velocities() const;
  // Replaces all positions and velocities (same order, 3 values per particle), these at time() unless they
  // are what velocities() tells. What methods and contact remember besides begins anew (docs/determinism.md): only
  // restore() gives a run back. Throws std::invalid_argument when the sizes differ
  // or a value is not finite.
  void set_state(std::span<const double> positions, std::span<const double> velocities);

  // Draws a particle of a cloth to a target by a spring of so many N/m, critically damped, until release();
  // another grab moves the target or takes another particle. Any stiffness is stable.
  void grab(int cloth, int particle, const Vec3& target, double stiffness = 200);
  void release();
  // Holds a particle where it is; lets a held one go, be it held by the scene or by pin().
  void pin(int cloth, int particle);
  void unpin(int cloth, int particle);
  // Moves all held particles of a cloth that have no keys at a velocity [m/s], up to 1e7 each way, until told
  // another; zero lets them rest. set_state() moves on from the positions that it sets.
  void carry(int cloth, const Vec3& velocity);
  // Cuts every constraint of any cloth that comes within `width` [m] of the segment from a to b, and
  // returns how many. A cloth that could not tear so far can from then on.
  int cut(const Vec3& a, const Vec3& b, double width);
  // Moves a collider evenly to `target` within the next frame, where it then rests: its sphere's or
  // box's center, its plane's point, its capsule's a. Replaces the keys of the scene.
  void move_collider(int collider, const Vec3& target);
  // These throw std::out_of_range for a particle or collider that is not there.

  // The run as it is now, and back to it, hands included: in the same scene, here or in another Simulation, the same
  // bits follow as if nothing had happened since, for any threads. restore() throws std::invalid_argument for a
  // snapshot of other cloths; what it has no room for (constraints that the scene does not have) is left
  // out.
  Snapshot snapshot() const;
  void restore(const Snapshot& snapshot);
  // Goes on with another scene: cloths whose grids have the same points, and meshes of as many vertices, keep
  // their state, pins and cuts that differ between the scenes are set, colliders that differ take the new
  // scene's place and keys; what
  // they meet there is moved out gently, as at a start.
  // Otherwise it starts anew. What is grabbed or carried is let go. Throws as the constructor does,
  // and then nothing has changed.
  void set_scene(Scene scene);
  // Takes over what the simulation does not look at (weft::draw_as) of another scene: no bit of the run changes.
  // Throws SceneError for a scene that is not valid.
  void draw_as(const Scene& scene);

  // Everything measured so far (weft/report.h). Evaluates energies and strains now. Without
  // `contacts` penetration and crossings, which cost most, are left out.
  Report report(bool contacts = true) const;

  // FNV-1a hash of the bits of all positions, as view() shows them, in scene order.
  std::uint64_t hash() const;

  // Bytes of state per particle, padding included.
  double bytes_per_particle() const;

  struct State;  // the library's own

 private:
  std::shared_ptr<State> state_;  // shared with those that hold memory()
};

}  // namespace weft
