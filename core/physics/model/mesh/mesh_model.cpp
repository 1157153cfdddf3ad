#include "physics/model/mesh/mesh_model.h"

#include <algorithm>
#include <cmath>

#include "physics/model/keyed_pins.h"
#include "physics/model/mesh/mesh_attachments.h"
#include "physics/model/mesh/mesh_tear_stage.h"
#include "physics/model/mesh/strand_sweep.h"
#include "physics/model/number.h"
#include "physics/model/path.h"
#include "physics/model/push.h"
#include "physics/model/segment_distance.h"

namespace weft::physics {
namespace {

// Where what no force reaches is heavy enough for arithmetic, and held.
constexpr double kLooseMass = 1;  // kg

}  // namespace

MeshModel::MeshModel(const Scene& scene, int index, Method method, std::uint64_t seed,
                     const KernelTable& kernels)
    : mesh_(*scene.cloths[std::size_t(index)].mesh.shape),
      method_(method),
      seed_(seed),
      surface_{mesh_.triangles, 0, sewn_vertices(scene.cloths[std::size_t(index)]), {}, {}},
      start_(placed_vertices(scene.cloths[std::size_t(index)].mesh)),
      rest_(rest_places(scene.cloths[std::size_t(index)].mesh)),
      triangles_(rest_triangles(mesh_, rest_, scene.cloths[std::size_t(index)].bending)),
      material_(material_of(scene.cloths[std::size_t(index)], method == Method::spring_friction)),
      order_(order_of(mesh_, surface_.sewn)),
      particles_(order_.counts, false, order_.vertices),
      seams_(surface_.sewn, particles_),
      parts_{scene, scene.cloths[std::size_t(index)], method_, particles_, kernels, *this},
      followed_(scene, parts_.cloth,
                [&](const Pin& pin) { return pin_alone_at(pin, start_[std::size_t(pin.i)], 0); }),
      edges_(edges_of(mesh_, rest_.x)) {
  if (rest_.uv_scale > 0) take_lengths(triangles_, edges_);
  const auto lane = [&](int p) { return std::uint32_t(particles_.lane(p)); };
  for (int p = 0; p < particles_.count(); ++p) drawn_.lanes.push_back(lane(p));
  for (const auto& [a, b, c] : mesh_.triangles)
    drawn_.triangles.push_back({lane(a), lane(b), lane(c)});
  drawn_.uv = mesh_.uv;
  weigh();
  place();
  if (parts_.cloth.pressure.given()) gas_ = std::make_unique<GasLoad>(parts_, seams_);
  const bool cut = std::any_of(scene.colliders.begin(), scene.colliders.end(),
                               [](const Collider& c) { return c.cuts; });
  if (cut || parts_.cloth.tear_strain > 0) allow_tearing();
}

// Sweeps that were made before know nothing of it. A gas would have nothing to push against.
void MeshModel::allow_tearing() {
  if (tearing_ || gas_) return;
  tearing_ = std::make_unique<MeshTearing>(MeshTearing::Parts{
      parts_.cloth, mesh_, order_, particles_, edges_, rest_.x, triangles_, surface_, drawn_});
  sweeps_.reset();
}

// A third of each triangle to each corner.
void MeshModel::weigh() {
  masses_.assign(start_.size(), 0);
  for (const RestTriangle& r : triangles_)
    for (std::size_t k = 0; k < 3; ++k)
      masses_[std::size_t(r.corner[k])] += parts_.cloth.density * r.area / 3;
}

void MeshModel::place() {
  particles_.for_each([&](int j, int i) {
    const auto p = std::size_t(particles_.number(j, i));
    for (int k = 0; k < 3; ++k) particles_.x.at(k, j, i) = coordinate(start_[p][std::size_t(k)]);
    const bool loose = masses_[p] == 0;
    if (loose) masses_[p] = kLooseMass;
    particles_.w(j)[i] = loose ? 0.0f : float(1 / masses_[p]);
  });
  for (const Pin& pin : parts_.cloth.pins) {
    const auto [j, i] = particles_.place(pin.i);
    particles_.w(j)[i] = 0;
    const Vec3 at = pin_alone_at(pin, start_[std::size_t(pin.i)], 0);
    for (int k = 0; k < 3; ++k) particles_.x.at(k, j, i) = coordinate(at[std::size_t(k)]);
  }
  for (int j = 0; j < particles_.rows; ++j) particles_.weigh_row(j);
  set_in_motion(particles_, parts_.cloth.velocity, parts_.cloth.spin, masses_);
}

void MeshModel::append_motion(Method method, StageList& list) {
  method_ = method;
  material_ = material_of(parts_.cloth, method == Method::spring_friction);
  history_.reset();
  midst_ = {};
  if (tearing_) tearing_->tell_nobody();
  if (sweeps_) sweeps_->follow_tears();
  is_explicit(method) ? append_forces(list) : append_projections(list);
  list.choose("sewing", make_sewing(parts_, seams_, history_.get()), "no seams in the scene");
}

void MeshModel::append_forces(StageList& list) {
  list.skip("predict, sweeps, velocity", "springs are forces with this method");
  list.skip("bending", material_.bends ? "the triangles' stage bends, too" : "bending is 0");
  append_gas(list);
  list.stages.push_back(make_triangles(parts_, order_, triangles_, material_, tearing_.get()));
  list.choose("wind", make_mesh_wind(parts_, order_, triangles_, seed_, tearing_.get()),
              "drag and lift are 0");
  list.choose("keyed_pins", make_keyed_pins(parts_), "no pin moves");
}

void MeshModel::append_gas(StageList& list) {
  list.choose("pressure", gas_ ? make_pressure(parts_, gas_->gas(), history_.get()) : nullptr,
              "the cloth has no pressure");
}

// As those of a grid (lattice_model.cpp).
void MeshModel::append_projections(StageList& list) {
  const Solver& solver = parts_.scene.solver;
  list.skip("triangles", "constraints are projected with this method");
  if (solver.order == 2 && particles_.previous.bytes() == 0)
    particles_.previous = Rows(particles_.rows, particles_.stride);
  if (solver.order == 2)
    history_ = std::make_unique<History>(particles_);
  else
    list.skip("second order", "order is 1");
  corrections_.reset();
  if (solver.tethers) corrections_ = std::make_unique<Rows>(particles_.rows, particles_.stride);
  colour_sweeps_ = sweeps_due();
  if (material_.membrane) strain_sweeps().append_places_before(list);
  list.stages.push_back(history_ ? make_predict_second_order(parts_, *history_, nullptr, nullptr)
                                 : make_predict(parts_, nullptr, corrections_.get(), nullptr));
  append_gas(list);
  list.choose("wind", make_mesh_wind(parts_, order_, triangles_, seed_, tearing_.get()),
              "drag and lift are 0");
  list.choose("keyed_pins", make_keyed_pins(parts_), "no pin moves");
  if (solver.tethers && tethers_.empty()) tethers_ = attachments();
  list.choose("tethers", solver.tethers ? make_tethers(parts_, tethers_, *corrections_) : nullptr,
              solver.tethers ? "nothing is pinned" : "off in the scene");
  if (solver.tethers) list.stages.push_back(make_corrections(parts_, *corrections_, nullptr));
  if (material_.membrane)
    append_membrane(list);
  else if (material_.stiffness == 0)
    list.skip("gauss_seidel", "stiffness is 0");
  else if (solver.sweep == Sweep::line)
    append_strands(list);
  else
    midst_.edges = edge_sweeps().append_edges(colour_sweeps_, history_.get(), list);
  if (material_.bends)
    sweeps().append_hinges(history_.get(), list);
  else
    list.skip("bending", "bending is 0");
  if (history_) list.stages.push_back(make_velocity_second_order(parts_, *history_, nullptr));
}

bool MeshModel::sweeps_by_colours() const {
  const bool lines = parts_.scene.solver.sweep == Sweep::line;
  return material_.membrane ? !lines || tearing_ : !lines && material_.stiffness > 0;
}

// Over membranes, sweeps make no motion of the first order.
ColourSweeps MeshModel::sweeps_due() const {
  const Membrane& m = parts_.cloth.membrane;
  double stiffest = 0;
  if (!material_.membrane)
    stiffest = material_.stiffness * *std::ranges::max_element(edges_.triangles);
  else if (parts_.scene.solver.order == 2)
    stiffest = std::max({m.warp, m.weft, m.shear});
  return colour_sweeps(parts_.scene.solver, dt_, stiffest / *std::ranges::min_element(masses_));
}

bool MeshModel::take_substep(double dt) {
  dt_ = dt;
  return !is_explicit(method_) && sweeps_by_colours() && sweeps_due() != colour_sweeps_;
}

void MeshModel::append_strands(StageList& list) {
  StrandSweeps sweeps(parts_, edges_, material_.stiffness, strands(), tearing_.get(),
                      history_.get());
  list.stages.push_back(sweeps.stage(parts_.scene.solver.iterations, true));
  midst_.edges = sweeps.midst();
}

const std::vector<Strand>& MeshModel::strands() {
  if (strands_.empty()) strands_ = strands_of(edges_, start_);
  return strands_;
}

std::vector<std::vector<Tether>> MeshModel::attachments() const {
  std::vector<int> pins;
  for (const Pin& pin : parts_.cloth.pins) pins.push_back(pin.i);
  return mesh_attachments(mesh_, rest_.x, pins);
}

MeshSweeps& MeshModel::sweeps() {
  if (!sweeps_) {
    sweeps_ = std::make_unique<MeshSweeps>(parts_, order_, seams_, tearing_.get());
    if (material_.bends) sweeps_->make_hinges(triangles_);
    sweeps_->follow_tears();
  }
  return *sweeps_;
}

MeshSweeps& MeshModel::edge_sweeps() {
  if (!sweeps().knows_edges()) sweeps_->make_edges(edges_, material_.stiffness);
  return *sweeps_;
}

StrainSweeps& MeshModel::strain_sweeps() {
  if (!sweeps().strains())
    sweeps_->make_strains(triangles_, parts_.scene.solver.sweep == Sweep::line);
  return *sweeps_->strains();
}

// Strands take turns with triangles, which go on from what these hold; they know nothing of tears.
void MeshModel::append_membrane(StageList& list) {
  const Solver& solver = parts_.scene.solver;
  StrainSweeps& strains = strain_sweeps();
  if (sweeps_by_colours()) {
    sweeps_->append_strains(colour_sweeps_, true, history_.get(), list);
    midst_.triangles = strains.midst();
    return;
  }
  StrandSweeps sweeps(parts_, edges_,
                      std::make_unique<StrandMembrane>(parts_, triangles_, edges_, strains),
                      strands(), history_.get());
  for (int n = 0; n < solver.iterations; ++n) {
    list.stages.push_back(sweeps.stage(1, n == 0));
    sweeps_->append_strains({1, false}, false, history_.get(), list);
  }
}

void MeshModel::append_limits(StageList& list) {
  list.choose("tear",
              parts_.cloth.tear_strain > 0 ? make_mesh_tear(parts_, *tearing_, midst_) : nullptr,
              "tear_strain is 0");
  if (parts_.cloth.strain_limit > 0)
    edge_sweeps().append_limit(parts_.cloth.strain_limit, list);
  else
    list.skip("strain_limit", "strain_limit is 0");
  const bool moved = parts_.cloth.strain_limit > 0 || !parts_.scene.colliders.empty();
  if (moved && seams_.count() > 0)
    list.stages.push_back(make_seam_hold(parts_, seams_, history_.get()));
}

Vec3 MeshModel::pin_position(const Pin& pin, double time) const {
  const Vec3 alone = pin_alone_at(pin, start_[std::size_t(pin.i)], time);
  return pin.follow < 0 ? alone : followed_.taken_along(pin, alone, time);
}

double MeshModel::stiffening(double stretch) const {
  return material_.membrane ? stiffening_of_membrane(stretch) : stiffening_of_springs(stretch);
}

bool MeshModel::folds_freely() const {
  return material_.membrane && (material_.c66 == 0 || material_.c11 == 0 || material_.c22 == 0);
}

// The bending that a mesh holds as it starts, in proportion to rigidity times squared angles, where it is to be
// flat.
std::vector<std::string> MeshModel::notes() const {
  constexpr double kCurved = 1e-3, kStretched = 1e-3;
  std::vector<std::string> notes;
  if (!is_explicit(method_) && material_.bend_damping > 0)
    notes.push_back("bending runs without its damping, which explicit methods alone have");
  if (tearing_ && material_.membrane && !is_explicit(method_) &&
      parts_.scene.solver.sweep == Sweep::line)
    notes.push_back(
        "strands do not follow tears of a membrane: gauss_seidel sweeps run in place of line, "
        "which hold less for the same substeps");
  if (!is_explicit(method_) && sweeps_by_colours())
    note_sweeps(colour_sweeps_, parts_.scene.solver, notes);
  const std::size_t loose = mesh_.edges.size();
  if (loose > 0 && !parts_.cloth.sewing)
    notes.push_back(std::to_string(loose) +
                    (loose == 1 ? " edge of the mesh belongs" : " edges of the mesh belong") +
                    " to no face; their ends are not sewn together (sewing is off)");
  if (loose == 0 && parts_.cloth.sewing)
    notes.push_back("sewing is on, but the mesh has no edge that belongs to no face");
  const Bending& bending = parts_.cloth.bending;
  const double rigidity = std::max({bending.warp, bending.weft, bending.twist});
  const double held = mesh_energy(triangles_, bending_alone(material_), start_);
  const MeshRest rest = parts_.cloth.mesh.rest;
  if (rest != MeshRest::shape && rigidity > 0 && held > kCurved * rigidity)
    notes.push_back("bending draws the mesh to its shape at rest: as it starts, it holds " +
                    number(held) + " J");
  if (const double strain = start_strain(); strain > kStretched)
    notes.push_back("the mesh starts with edges up to " + number(100 * strain) +
                    " % longer or shorter than at rest");
  return notes;
}

std::vector<Joined> MeshModel::constraints_near(const Vec3& a, const Vec3& way,
                                                double distance) const {
  const std::vector<Vec3> x = particles_.gather(particles_.x);
  std::vector<Joined> found;
  for (std::size_t n = 0; n < edges_.ends.size(); ++n) {
    if (!holds(n)) continue;
    const Joined& edge = edges_.ends[n];
    const Vec3 &from = x[std::size_t(edge[0])], &to = x[std::size_t(edge[1])];
    if (segment_distance(a, way, from, minus(to, from)) <= distance) found.push_back(edge);
  }
  return found;
}

std::size_t MeshModel::bytes() const {
  std::size_t strands = 0;
  for (const Strand& s : strands_)
    strands += sizeof(Strand) + (s.vertices.size() + s.edges.size()) * sizeof(int);
  return strands + particles_.bytes() + triangles_.size() * sizeof(RestTriangle) +
         edges_.ends.size() * (sizeof(Joined) + sizeof(double)) +
         start_.size() * (sizeof(Vec3) + sizeof(double)) + (sweeps_ ? sweeps_->bytes() : 0) +
         (history_ ? history_->bytes() : 0) + (corrections_ ? corrections_->bytes() : 0) +
         seams_.bytes() + (gas_ ? gas_->bytes() : 0) + (tearing_ ? tearing_->bytes() : 0);
}

}  // namespace weft::physics
