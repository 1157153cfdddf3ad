// The scene: plain data that says what to simulate. Everything is SI (m, kg, s, N), y is up.
// A Scene is read from JSON by read_scene() (weft/read_scene.h) or filled in by hand, checked by
// validate(), and handed to a Simulation (weft/simulation.h), which never changes it.
// docs/scene.schema.json states the range of every field; defaults here and there are equal.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "weft/pin.h"
#include "weft/pressure.h"
#include "weft/shapes/list.h"

namespace weft {

// A rectangular sheet of nx*ny particles: particle (i,j) starts at
// origin + u i/(nx-1) + v j/(ny-1). Rest lengths are those of the flat sheet.
struct Grid {
  int nx = 2;         // particles along u, 2 … 4096
  int ny = 2;         // particles along v, 2 … 4096
  Vec3 origin{};      // m
  Vec3 u{1, 0, 0};    // whole side, m; u and v are not parallel
  Vec3 v{0, 0, 1};    // whole side, m
  double jitter = 0;  // m; each particle starts up to this far off the sheet along its normal
  friend bool operator==(const Grid&, const Grid&) = default;
};

// What the triangles of a mesh are like at rest: `shape`, as the mesh is, curvature included; `flat`, of its
// lengths, and bending is towards flat; `uv`, those of its texture coordinates, a flat pattern; `file`, those
// of a second mesh with the same triangles.
enum class MeshRest { shape, flat, uv, file };

// A mesh as cloth.
struct ClothMesh : MeshSource {
  MeshRest rest = MeshRest::shape;
  MeshSource at_rest{};  // with `file`: as read, scaled as the mesh is
  double uv_scale = 1;   // m; of a unit of the texture coordinates, with `uv`
  friend bool operator==(const ClothMesh&, const ClothMesh&) = default;
};

// One value for each kind of constraint: structural (1,0) (0,1), shear (1,1) (1,-1),
// bend (2,0) (0,2), as offsets on the grid.
struct Kinds {
  double structural = 0;
  double shear = 0;
  double bend = 0;
  friend bool operator==(const Kinds&, const Kinds&) = default;
};

// The sheet as a continuum: stress is C (e + damping de/dt), with e Green's strain along warp (u) and weft
// (v) and the angle between the two. In place of springs where it is given.
struct Membrane {
  double warp = 0;  // N/m, C11
  double weft = 0;  // N/m, C22
  // N/m, C12; |C12| is at most the root of C11 C22: the energy stays above zero.
  double coupling = 0;
  double shear = 0;    // N/m, C66
  double damping = 0;  // s
  bool given() const { return warp > 0 || weft > 0 || shear > 0; }
  friend bool operator==(const Membrane&, const Membrane&) = default;
};

// Energy of curvature, an area: warp k11²/2 + weft k22²/2 + twist k12² [N·m]. A plate without lateral
// contraction of flexural rigidity D has D for all three: a plain number.
struct Bending {
  double warp = 0, weft = 0, twist = 0;  // N·m
  double damping = 0;                    // s; moments are D (k + damping dk/dt)
  Bending(double all = 0) : warp(all), weft(all), twist(all) {}
  bool given() const { return warp > 0 || weft > 0 || twist > 0; }
  bool plain() const { return warp == weft && warp == twist && damping == 0; }
  friend bool operator==(const Bending&, const Bending&) = default;
};

// A line over a flat sheet, from point to point [column, row] of the grid, whole numbers being particles. It
// may leave the sheet: a cut from border to border begins and ends beside it.
using CutLine = std::vector<std::array<double, 2>>;
using Seam = std::array<int, 2>;  // vertices of a mesh that become one

enum class SelfCollisionMode { off, particles, surface };

// How a pair closer than the thickness is pushed apart: `stiff` separates it at once with
// friction, `course` averages the corrections and divides them by the substeps, and neighbours on the grid,
// which do not touch otherwise, are pairs as well unless they are that near at rest (seeds 001 and 004);
// `neighbours` separates as stiff does, but for neighbours on the grid, which push as by `course`.
enum class SelfCollisionResponse { stiff, course, neighbours };

struct SelfCollision {
  SelfCollisionMode mode = SelfCollisionMode::off;
  double thickness = 0.01;  // m; the least distance between two layers
  double friction = 0.3;    // Coulomb, between layers (stiff); of two cloths the mean counts
  SelfCollisionResponse response = SelfCollisionResponse::stiff;
  friend bool operator==(const SelfCollision&, const SelfCollision&) = default;
};

// What a constraint that ends takes with it, and what is shown: `split`, each side's share of the
// triangles in its way, so that the tear is a line that opens; `holes`, none of these triangles;
// `particles`, both particles that it joined lose all constraints and triangles (seed 000).
enum class Tears { split, holes, particles };

// Diagonals of a level: both, or (i+n, j+n) alone (seed 000).
enum class LevelDiagonals { both, one };

// In which order a strain limit shortens constraints: `colours`, structural and shear, those that share no
// particle side by side; `course`, all of them, bend as well, one after the other: row by row, from every
// particle to the left, above, above left, above right, two to the left, two above (seeds 001 and 004). Both
// are one pass a substep and overshoot; `strict` holds the limit, by forces that last from substep to substep,
// on structural and shear constraints.
enum class StrainLimitOrder { colours, course, strict };

// What particles and constraints at the border of a sheet count for. `area`: a particle weighs the area
// that it stands for, a quarter of an inner one's in a corner and half of it elsewhere on the border, and
// what lies along the border acts on half a spacing of cloth, with half the stiffness. The lattice is then
// within the square of its spacing of the sheet; `equal`, all alike, is so in first order only. `automatic`:
// `area` where density gives the masses, `equal` where they are given per particle.
enum class Lumping { automatic, area, equal };

// The colours of a cloth's two sides, "#rrggbb" as displays have them (sRGB); "": who draws it chooses. The
// simulation does not look at them.
struct ClothColor {
  std::string front, back;
  friend bool operator==(const ClothColor&, const ClothColor&) = default;
};

// Red, green and blue, 0 … 1 in proportion to light, of a colour as ClothColor has it; nothing of any other text.
std::optional<std::array<double, 3>> linear_color(const std::string& text);

struct Cloth {
  Grid grid;
  ClothMesh mesh;              // given: in place of the grid
  double density = 0.3;        // kg/m²; total mass density*|u x v|, shared as `lumping` says
  double particle_mass = 0;    // kg; > 0 replaces density
  std::vector<double> masses;  // kg, nx*ny in row-major order; not empty: replaces both
  Lumping lumping = Lumping::automatic;  // of masses by density, and of stiffness
  Kinds stiffness{1000, 1000, 200};      // N/m; 0 = none of that kind
  Kinds spring_damping;                  // N·s/m along the spring (method spring_friction)
  Membrane membrane;                     // given: in place of springs
  int level = 0;  // n >= 1: constraints to distance 1..n along rows, columns and
                  // diagonals, all with stiffness.structural (seed 000)
  LevelDiagonals level_diagonals = LevelDiagonals::both;  // where level is not 0
  // 0 … 1: relative drop of stiffness from first row to last (seed 003).
  double stiffness_gradient = 0;
  double positional_k = 0.5;  // 0 … 0.5: share of the error each end takes (method positional)
  Vec3 velocity{};            // m/s; of all free particles at the start
  Vec3 spin{};                // rad/s; at the start, about the cloth's center of mass
  double drag = 0;            // 1/s; velocity is multiplied by 1 - dt*drag each substep
  Bending bending;            // energy of curvature
  double strain_limit = 0;    // 0.1 = structural and shear constraints never beyond 110 %; 0 = off
  StrainLimitOrder strain_limit_order = StrainLimitOrder::strict;
  double tear_strain = 0;  // 0.5 = a constraint beyond 150 % is cut; 0 = cannot tear
  Tears tears = Tears::split;
  SelfCollision self_collision;
  std::vector<Pin> pins;
  // Along these lines the sheet is cut from the start: no constraint that crosses one is there.
  std::vector<CutLine> cuts;
  bool sewing = false;      // edges of a mesh file that belong to no face are seams
  std::vector<Seam> seams;  // of a mesh, besides those
  Pressure pressure{};      // of a closed mesh
  ClothColor color{};
  friend bool operator==(const Cloth&, const Cloth&) = default;
};

// `coulomb`: a particle in contact sticks while the tangential motion is within `statik` times the
// normal correction, else slides with `dynamic`. `course`: the whole correction from the previous
// position is multiplied by 1 - dynamic (seeds 001 and 004).
enum class FrictionModel { coulomb, course };

// Damping acts on what is nearer than `bias` to the surface on which cloth is kept, whether it touches or
// not: its velocity along the surface, as seen from there, is multiplied by 1 - dt*damping each substep
// (seed 003). With `coulomb` alone, and only if both are above 0.
struct Friction {
  FrictionModel model = FrictionModel::coulomb;
  double statik = 0;   // >= dynamic
  double dynamic = 0;  // >= 0; course: 0 … 1
  double damping = 0;  // 1/s
  double bias = 0;     // m
  bool damps() const { return model == FrictionModel::coulomb && damping > 0 && bias > 0; }
  friend bool operator==(const Friction&, const Friction&) = default;
};

struct Collider {
  Shape shape;
  Friction friction;
  double offset = 0;  // m; the cloth is kept this far off the surface
  // Path of its place: a center, a plane's point, the end a of an axis, a mesh's translate.
  std::vector<Key> keys;
  bool cuts = false;  // cuts the constraints that pass through it instead of pushing
  // Of a mesh: its vertices over time, placed as it is: .pc2, .mdd, .glb or .gltf beside the scene file, or absolute.
  std::string animation{};
  // It turns about an axis, where the scene has its shape, and then goes along its keys, axis and all.
  Rotation rotate{};
  std::string color{};  // as ClothColor has them; "": who draws it chooses
  friend bool operator==(const Collider&, const Collider&) = default;
};

struct Wind {
  Vec3 velocity{};                   // m/s
  double drag = 0;                   // kg/m³; force per area and speed² along the normal
  double lift = 0;                   // kg/m³; the same across the flow
  double turbulence = 0;             // 0 … 1; relative size of random gusts
  std::vector<Key> velocity_keys{};  // m/s in place of m; not empty: replaces velocity
  friend bool operator==(const Wind&, const Wind&) = default;
};

enum class Method { positional, spring, spring_friction, compliant };
enum class Sweep { gauss_seidel, jacobi, line };

struct Solver {
  Method method = Method::spring;
  Sweep sweep = Sweep::gauss_seidel;  // positional and compliant
  bool tethers = false;               // one-sided distance to the pins (positional, compliant)
  int order = 1;                      // 2: second-order substep (compliant)
  int iterations = 1;                 // constraint sweeps per substep, 1 … 1000
  // Of springs: every iteration adds their forces again, which count `iterations` times (seed 000).
  bool iterate_springs = false;
  // Of springs: the first substep adds a whole substep of acceleration to the velocities, not half of one, as
  // position Verlet does whose previous positions are its first (the course).
  bool full_first_kick = false;
  int collision_iterations = 1;  // passes over the colliders per substep, 1 … 100
  double sleep = 0;              // m/s; 0 … 1: row-blocks slower than this for half a second rest
                                 // until something moves them; 0 = nothing ever rests
  friend bool operator==(const Solver&, const Solver&) = default;
};

inline constexpr int kAutoSubsteps = 0;
struct Time {
  double frame = 1.0 / 60;       // s; one frame, 1e-5 … 1
  int substeps = kAutoSubsteps;  // per frame, 1 … 100000; kAutoSubsteps: from the stability limit
  double seconds = 5;            // s; how long a run lasts unless told otherwise
  friend bool operator==(const Time&, const Time&) = default;
};

// From where the scene is best seen; the simulation does not look at it.
struct Sight {
  double azimuth = 30;    // degrees about y from +z towards +x, -360 … 360
  double elevation = 17;  // degrees above the level, -85 … 85
  double zoom = 1;        // > 1: nearer than what shows all of the cloth, 0.01 … 100
  friend bool operator==(const Sight&, const Sight&) = default;
};

struct Scene {
  std::string name;
  std::string about;                // one line for `weft scenes`
  Vec3 gravity{0, -9.81, 0};        // m/s²
  std::vector<Key> gravity_keys{};  // m/s² in place of m; not empty: replaces gravity
  Time time;
  Solver solver;
  std::vector<Cloth> cloths;
  std::vector<Collider> colliders;
  Wind wind;
  Sight camera;
  friend bool operator==(const Scene&, const Scene&) = default;
};

// One thing wrong with a scene: where (a JSON pointer, "" for the whole), what is wrong, and what
// would be allowed ("" when `what` already says it).
struct Fault {
  std::string place;
  std::string what;
  std::string allowed;
};

// Every fault of a scene, empty when it can be simulated. A Simulation refuses any other.
std::vector<Fault> validate(const Scene& scene);

// How many particles a cloth has; 0 where its mesh is not read yet.
int particle_count(const Cloth& cloth);

// Where the vertices of a mesh, which is read, start [m], and where one of them does.
std::vector<Vec3> placed_vertices(const MeshSource& mesh);
Vec3 placed_vertex(const MeshSource& mesh, int vertex);

// Spacing of the grid along u and v [m].
double spacing_u(const Grid& grid);
double spacing_v(const Grid& grid);

// The scene with all that has a place, and all paths, moved by so much [m].
Scene moved(Scene scene, const Vec3& by);

// Where particle (i,j) of a grid starts, but for jitter [m].
Vec3 place_on(const Grid& grid, int i, int j);

// The number of particle (i,j): row after row.
inline int particle_number(const Grid& grid, int i, int j) {
  return j * grid.nx + i;
}

// The number of the particle that a pin of one holds.
inline int particle_number(const Cloth& cloth, const Pin& pin) {
  return cloth.mesh.given() ? pin.i : particle_number(cloth.grid, pin.i, pin.j);
}

// The particles that a pin holds, by number, ascending where they are several. What is not there is left
// out: a group that the mesh has not, or all of a mesh that is not read.
std::vector<int> held_particles(const Cloth& cloth, const Pin& pin);

// The pins of a cloth, whose mesh is read, with one for each particle that they hold, on the same paths.
std::vector<Pin> single_pins(const Cloth& cloth);

// Mass of particle (i,j) of a grid [kg] by the cloth's masses, particle_mass, or density and lumping.
double particle_mass(const Cloth& cloth, int i, int j);

// What a cloth weighs [kg/m²]: its density, or, of particles with masses, that in the middle over its square.
double area_density(const Cloth& cloth);

// Takes over what the simulation does not look at: name, about, camera, and the colours of cloths and colliders,
// each from the one with its number.
void draw_as(const Scene& from, Scene& to);

// Whether two scenes differ at most in what the simulation does not look at.
bool moves_alike(const Scene& a, Scene b);

// Whether a cloth's border counts half (Lumping::area, be it by Lumping::automatic).
bool lumps_by_area(const Cloth& cloth);

// The share of the cloth's stiffness that a constraint from particle (i,j) to (i+di,j+dj) has: the width
// of cloth it stands for, of the spacing. 1/2 along a border of a cloth that lumps by area, else 1.
double width_share(const Cloth& cloth, int i, int j, int di, int dj);

}  // namespace weft
