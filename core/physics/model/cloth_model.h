// What a cloth is made of: the seam between the frame, which knows particles, stages and energies, and
// the constraints that hold a cloth together. A model owns its particles and all that is fixed by the
// scene; it is asked once a build or once a frame, never for a row.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "physics/model/load.h"
#include "physics/model/particles.h"
#include "physics/model/spectrum.h"
#include "physics/model/surface_mesh.h"
#include "physics/model/tearing.h"
#include "physics/step/stage_list.h"

namespace weft::physics {

struct ElasticEnergy {
  double springs = 0, membrane = 0, bending = 0;  // J
  double sum() const { return springs + membrane + bending; }
};

class ClothModel;
struct LatticeParts;
class MeshTearing;
struct History;

// Whether a method integrates springs as forces, and so has a stability limit.
inline bool is_explicit(Method m) {
  return m == Method::spring || m == Method::spring_friction;
}

// What every stage of one cloth refers to; outlives the stages.
struct ClothParts {
  const Scene& scene;
  const Cloth& cloth;
  const Method& method;  // that runs: the scene's, or a stable one in its place
  Particles& particles;
  const KernelTable& kernels;
  const ClothModel& model;
};

// How hard a cloth's constraints pull.
struct Pull {
  double stiffness = 0;  // N/m, of the stiffest
  double force = 0;      // N, of the strongest at twice its length
  double acceleration =
      0;  // m/s², of a particle at most, one constraint of each kind at twice its length
};

struct ConstraintCounts {
  std::int64_t structural = 0, shear = 0, bend = 0;
};

// Of structural constraints: |e|/l - 1.
struct Strain {
  double max = 0, mean = 0;
  std::int64_t constraints = 0;
};

// Seams whose ends are apart, of so many, and how far an end is from the middle of its seam at most [m].
struct OpenSeams {
  int open = 0, all = 0;
  double widest = 0;
};

class ClothModel {
 public:
  virtual ~ClothModel() = default;

  virtual const ClothParts& parts() const = 0;
  Particles& particles() const { return parts().particles; }
  // The grid behind the cloth, for stages that use its implicit structure; null where there is none.
  virtual LatticeParts* lattice() { return nullptr; }
  // What tears of a mesh, for cutters; null where there is none.
  virtual MeshTearing* mesh_tearing() { return nullptr; }

  // What substeps of the second order keep from one to the next; null: they are of the first.
  virtual History* history() { return nullptr; }
  // Appends the stages that move the particles by this method and the scene's solver, up to contact;
  // then, after those of contact, what may not be exceeded at a substep's end.
  virtual void append_motion(Method method, StageList& list) = 0;
  virtual void append_limits(StageList& list) = 0;
  // Substeps have this length from now on [s]; true: they take other stages than those that were appended.
  virtual bool take_substep(double dt) {
    (void)dt;
    return false;
  }
  virtual double mass(int particle) const = 0;  // kg, held or not

  // The triangles that are left.
  virtual const SurfaceMesh& surface() const = 0;
  // What views show of a mesh; null: they know grids by themselves.
  virtual const DrawnMesh* drawn_mesh() const { return nullptr; }
  virtual ConstraintCounts constraints() const = 0;
  virtual Pull pull() const = 0;

  // Of the cloth as it lies now, in double precision: accelerations [m/s²] by gravity and all inner
  // forces, zero for held particles; energy [J] of stretching and bending; strain.
  virtual void accelerations(const Vec3& gravity, std::vector<Vec3>& a) const = 0;
  virtual ElasticEnergy elastic_energy() const = 0;
  virtual Strain strain() const = 0;

  // The greatest strain of the constraints that the strain limit holds.
  virtual double limited_strain() const = 0;
  // Where a pin of the cloth is held at a time [s].
  virtual Vec3 pin_position(const Pin& pin, double time) const = 0;

  // Of the cloth with its particles at `x`: the energy that its constraints hold as the method feels them in
  // substeps of dt, with what rounding of the positions puts in at once [J]; dt 0: with all their stiffness, and
  // without what a strain limit takes back. The greatest squared length of the constraints that carry the cloth,
  // of their rest.
  virtual double held_energy(const Rows& x, double dt, Threads& threads) const = 0;
  virtual float greatest_stretch(const Rows& x) const = 0;
  // The greatest strain along lines that sweeps may solve as a whole, that of each constraint spread over so many
  // (strain_in_line.h); 0: there are no lines.
  virtual double strain_in_line(const Rows& x, double spread) const = 0;
  // J; the energy of attachments that are stretched, and what springs gain in a substep by positions
  // that are rounded anew.
  virtual double attachment_energy(const Rows& x, double dt) const = 0;
  virtual double rounding_gain() const = 0;

  // What acts on the cloth besides its constraints and has an energy; null: nothing. Accelerations and energies
  // above are without it.
  virtual const Load* load() const { return nullptr; }

  // What limits explicit substeps: the spectrum of the cloth as it starts, with these inverse masses, and the largest
  // substep [s] by the one that was found last.
  Spectrum spectrum(std::span<const float> inverse_masses) const {
    found_ = find_spectrum(inverse_masses);
    return *found_;
  }
  double largest_substep() const {
    if (!found_) spectrum(particles().inverse_mass.span());
    return found_->largest_substep();
  }
  // Whether it can fold without stretching anything, onto a line where all its springs pull the same way.
  virtual bool folds_freely() const = 0;
  // By how much ω² grows at most where constraints are `stretch` times as long as at rest.
  virtual double stiffening(double stretch) const = 0;

  // What the cloth is not as the scene asks, by the method that runs: a sentence each.
  virtual std::vector<std::string> notes() const { return {}; }

  virtual OpenSeams open_seams() const { return {}; }
  // Marks the particles, by number, of seams that have an end farther than so much from their middle [m].
  virtual void mark_open_seams(double beyond, std::span<std::uint8_t> marks) const {
    (void)beyond, (void)marks;
  }

  // Null while the cloth cannot tear; after allow_tearing() it can, where the model knows how, and its
  // stages are to be chosen anew. And the constraints that come within a distance [m] of a segment from a
  // along `way`.
  virtual Tearing* tearing() { return nullptr; }
  virtual const Tearing* tearing() const { return nullptr; }
  virtual void allow_tearing() {}
  virtual std::vector<Joined> constraints_near(const Vec3& a, const Vec3& way,
                                               double distance) const = 0;

  virtual std::size_t bytes() const = 0;

 private:
  virtual Spectrum find_spectrum(std::span<const float> inverse_masses) const = 0;
  mutable std::optional<Spectrum> found_;
};

// The model that a scene asks for, with the particles as they start. `index`: of the cloth in the scene,
// which outlives the model; `seed`: of all random choices.
std::unique_ptr<ClothModel> make_model(const Scene& scene, int index, Method method,
                                       std::uint64_t seed, const KernelTable& kernels);
using MakeModel = std::unique_ptr<ClothModel> (*)(const Scene&, int, Method, std::uint64_t,
                                                  const KernelTable&);

}  // namespace weft::physics
