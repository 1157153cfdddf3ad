// Builds a grid's model, and chooses the stages that move it (lattice_model.h).
#include "physics/model/lattice/lattice_model.h"

#include <algorithm>
#include <limits>

#include "physics/model/keyed_pins.h"
#include "physics/model/lattice/cuts.h"
#include "physics/model/lattice/plain_rows.h"
#include "physics/model/lattice/stability.h"
#include "physics/model/number.h"
#include "physics/model/path.h"

namespace weft::physics {
namespace {

// Whether a stage asks where particles were before the substep.
bool keeps_previous(const Solver& solver, Method method) {
  return !is_explicit(method) && solver.order == 2;
}

}  // namespace

LatticeModel::LatticeModel(const Scene& scene, int index, Method method, std::uint64_t seed,
                           const KernelTable& kernels)
    : index_(index),
      seed_(seed),
      method_(method),
      stencils_(stencils_of(scene.cloths[std::size_t(index)], scene.solver)),
      lattice_(make_lattice(scene.cloths[std::size_t(index)], index, seed,
                            keeps_previous(scene.solver, method))),
      parts_{{scene, scene.cloths[std::size_t(index)], method_, lattice_, kernels, *this},
             lattice_,
             stencils_},
      followed_(scene, parts_.cloth,
                [&](const Pin& pin) { return pin_alone_at(parts_.cloth, pin, 0); }) {
  const bool cut = std::any_of(scene.colliders.begin(), scene.colliders.end(),
                               [](const Collider& c) { return c.cuts; });
  if (cut || parts_.cloth.tear_strain > 0 || !parts_.cloth.cuts.empty()) allow_tearing();
  if (!parts_.cloth.cuts.empty()) tearing_->end_all(cut_constraints());
}

std::vector<Joined> LatticeModel::cut_constraints() const {
  const Grid& grid = parts_.cloth.grid;
  std::vector<Joined> cut;
  for (const Stencil& f : stencils_)
    for_each_cut(parts_.cloth.cuts, grid, f.di, f.dj, [&](int i, int j, double) {
      cut.push_back({particle_number(grid, i, j), particle_number(grid, i + f.di, j + f.dj)});
    });
  return cut;
}

void LatticeModel::allow_tearing() {
  if (tearing_) return;
  tearing_ = std::make_unique<LatticeTearing>(lattice_, stencils_, parts_.cloth);
  parts_.tearing = tearing_.get();
}

double LatticeModel::mass(int particle) const {
  const auto [j, i] = lattice_.place(particle);
  return particle_mass(parts_.cloth, i, j);
}

void LatticeModel::append_motion(Method method, StageList& list) {
  method_ = method;
  multipliers_.reset();
  corrections_.reset();
  limit_forces_.reset();
  history_.reset();
  overlong_.clear();
  ended_.clear();
  parts_.overlong = nullptr;
  parts_.ended = nullptr;
  is_explicit(method) ? append_forces(list) : append_projections(list);
}

void LatticeModel::append_forces(StageList& list) {
  if (parts_.cloth.tear_strain > 0 && is_plain(parts_) && !is_membrane())
    overlong_.resize(std::size_t(lattice_.rows));
  parts_.overlong = overlong_.empty() ? nullptr : overlong_.data();
  list.skip("predict, sweeps, velocity", "springs are forces with this method");
  const bool bends = parts_.cloth.bending.given();
  const auto left = std::make_shared<Remainders>();
  list.choose("bending", is_membrane() ? nullptr : make_bending_force(parts_, left),
              is_membrane() && bends ? "the membrane's stage bends, too" : "bending is 0");
  list.stages.push_back(is_membrane()
                            ? make_membrane(parts_)
                            : make_springs(parts_, method_ == Method::spring_friction, left));
  list.choose("wind", make_wind(parts_, seed_), "drag and lift are 0");
  list.choose("keyed_pins", make_keyed_pins(parts_), "no pin moves");
}

// Of colour_sweeps(); 0: sweeps make no motion. (Over cells of membranes one makes some, of the second order, but several
// do not, whichever way they go. Jacobi's have no direction.)
double LatticeModel::stiffness_rate() const {
  const Solver& solver = parts_.scene.solver;
  if (solver.sweep != Sweep::gauss_seidel || (solves_membrane() && solver.order == 1)) return 0;
  if (method_ == Method::positional) return std::numeric_limits<double>::infinity();
  return greatest_stiffness(parts_.cloth) / lightest_mass(parts_.cloth);
}

ColourSweeps LatticeModel::sweeps_due() const {
  return colour_sweeps(parts_.scene.solver, dt_, stiffness_rate());
}

bool LatticeModel::take_substep(double dt) {
  dt_ = dt;
  return !is_explicit(method_) && sweeps_due() != sweeps_;
}

void LatticeModel::append_projections(StageList& list) {
  const Solver& solver = parts_.scene.solver;
  list.skip("springs", "constraints are projected with this method");
  SweepOptions sweep;
  sweep.compliant = method_ == Method::compliant;
  const bool lines = solver.sweep == Sweep::line;
  const ColourSweeps sweeps = sweeps_ = sweeps_due();
  const bool damps = solves_membrane() && parts_.cloth.membrane.damping > 0;
  if (sweep.compliant && !lines && sweeps.count > 1)
    multipliers_ = std::make_unique<Multipliers>(
        lattice_, solves_membrane() ? kCellStresses * (damps ? 2 : 1) : stencils_.size());
  sweep.multipliers = multipliers_.get();
  // Jacobi sweeps find all corrections of a particle at once, and need not gather them.
  const bool gather = solver.sweep != Sweep::jacobi;
  const bool bends = parts_.cloth.bending.given();
  if (gather || solver.tethers || bends)
    corrections_ = std::make_unique<Rows>(lattice_.rows, lattice_.stride);
  sweep.corrections = corrections_.get();
  if (solver.order == 2)
    history_ = std::make_unique<History>(lattice_);
  else
    list.skip("second order", "order is 1");
  const auto left = history_ ? nullptr : std::make_shared<Remainders>();
  sweep.left = left;
  list.stages.push_back(
      history_
          ? make_predict_second_order(parts_, *history_, multipliers_.get(), corrections_.get())
          : make_predict(parts_, multipliers_.get(), corrections_.get(), left));
  list.choose("wind", make_wind(parts_, seed_), "drag and lift are 0");
  list.choose("keyed_pins", make_keyed_pins(parts_), "no pin moves");
  list.choose("tethers", solver.tethers ? make_attachments(parts_, *corrections_) : nullptr,
              solver.tethers ? "nothing is pinned" : "off in the scene");
  if (!gather && solver.tethers)
    list.stages.push_back(make_corrections(parts_, *corrections_, left));
  // Where sweeps hold every constraint for itself or with its line, its length changes in their midst. Seed 000
  // asks constraints as they lie, however unevenly.
  const bool tears = parts_.cloth.tear_strain > 0 && gather && !stencils_.empty() &&
                     parts_.cloth.tears != Tears::particles;
  if (tears) ended_.resize(std::size_t(lattice_.rows));
  if (tears) parts_.ended = ended_.data();
  if (lines) {
    const float share = sweep.compliant ? 1.0f : float(2 * parts_.cloth.positional_k);
    list.choose("line",
                make_line(parts_, *corrections_,
                          {sweep.compliant, solver.iterations, share, solves_membrane(),
                           !solver.tethers, tears}),
                "the cloth has no constraints");
  } else {
    list.skip("line", "sweep is not line");
    if (stencils_.empty())
      list.skip(gather ? "gauss_seidel" : "jacobi", "the cloth has no constraints");
    for (int n = 0; n < sweeps.count && damps; ++n)
      append_membrane_damping(parts_, *corrections_, multipliers_.get(), list.stages);
    for (int n = 0; n < sweeps.count && !stencils_.empty(); ++n) {
      sweep.backwards = sweeps.backwards(n);
      sweep.tears = tears && n + 1 == sweeps.count;
      if (solver.sweep == Sweep::jacobi)
        list.stages.push_back(make_jacobi(parts_, sweep));
      else if (solves_membrane())
        append_membrane_sweep(parts_, sweep, list.stages);
      else
        append_gauss_seidel(parts_, sweep, list.stages);
    }
  }
  // What comes last stays as solved, and stretching undoes more of bending than that of stretching.
  list.choose("bending", bends ? make_bending(parts_, *corrections_) : nullptr, "bending is 0");
  if (history_)
    list.stages.push_back(make_velocity_second_order(parts_, *history_, corrections_.get()));
  else if (corrections_)
    list.stages.push_back(make_corrections(parts_, *corrections_, left));
}

void LatticeModel::append_limits(StageList& list) {
  list.choose("tear", parts_.cloth.tear_strain > 0 ? make_tear(parts_, *tearing_) : nullptr,
              "tear_strain is 0");
  if (parts_.cloth.strain_limit <= 0) return list.skip("strain_limit", "strain_limit is 0");
  if (parts_.cloth.strain_limit_order == StrainLimitOrder::course)
    return list.stages.push_back(make_course_limit(parts_));
  if (parts_.cloth.strain_limit_order == StrainLimitOrder::strict && !history_) {
    limit_forces_ = std::make_unique<Multipliers>(lattice_, stencils_.size());
    return append_held_limit(parts_, *limit_forces_, list.stages);
  }
  SweepOptions limit;
  limit.limit = parts_.cloth.strain_limit;
  append_gauss_seidel(parts_, limit, list.stages);
}

// Jacobi sweeps and the method positional know springs alone; the past of order 2 is not the start of the substep, which a
// limit that holds compares with.
std::vector<std::string> LatticeModel::notes() const {
  std::vector<std::string> notes;
  if (history_ && parts_.cloth.strain_limit > 0 &&
      parts_.cloth.strain_limit_order == StrainLimitOrder::strict)
    notes.push_back(
        "with order 2 the strain limit is one pass a substep, as with colours, and keeps momentum "
        "to some "
        "thousandths");
  if (!is_explicit(method_) && !stencils_.empty()) note_sweeps(sweeps_, parts_.scene.solver, notes);
  const Membrane& m = parts_.cloth.membrane;
  if (!m.given() || is_membrane() || solves_membrane()) return notes;
  std::string note =
      "springs of the membrane's warp, weft and shear run in its place, without its damping";
  if (m.coupling != m.shear)
    note +=
        "; they couple warp and weft by " + number(m.shear) + " N/m, not by " + number(m.coupling);
  // Where the coupling differs, so does the strain, however fine the substeps are.
  notes.push_back(note +
                  " (method compliant with gauss_seidel or line sweeps, or method spring, "
                  "solves the membrane itself)");
  return notes;
}

std::size_t LatticeModel::bytes() const {
  std::size_t bytes = lattice_.bytes() + (multipliers_ ? multipliers_->bytes() : 0) +
                      (corrections_ ? corrections_->bytes() : 0) +
                      (limit_forces_ ? limit_forces_->bytes() : 0) +
                      (history_ ? history_->bytes() : 0);
  if (tearing_)
    bytes += tearing_->bytes() + overlong_.size() + ended_.size() * sizeof(std::int32_t);
  return bytes;
}

}  // namespace weft::physics
