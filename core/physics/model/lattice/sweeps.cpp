// Stages "gauss_seidel" and "jacobi": one sweep of projections over all constraint stencils.
//
// Gauss–Seidel goes by row offset dj, along the rows first, then colour by colour, stencil by
// stencil, or all that backwards: constraints a of one row alternate by a/|di|, those between rows by j/dj, so that the
// constraints of a stencil and colour are disjoint and may be solved side by side. The order depends
// on nothing but the scene.
#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <numbers>

#include "physics/model/lattice/plain_rows.h"
#include "physics/model/path.h"
#include "physics/step/keeper.h"

namespace weft::physics {
namespace {

constexpr int kColours = 2;

// The stencils of a sweep with one row offset dj, as their kernel takes them.
class ProjectedStencils {
 public:
  ProjectedStencils(const LatticeParts& parts, const SweepOptions& options, int dj)
      : parts_(parts), options_(options) {
    for (std::size_t f = 0; f < parts.stencils.size(); ++f)
      if (parts.stencils[f].dj == dj && swept(parts.stencils[f], options)) add(f);
    if (!options.backwards) return;
    std::ranges::reverse(members_);
    std::ranges::reverse(rows_);
  }

  // Bend constraints join second neighbours; the strain limit is one on the cloth's own edges.
  static bool swept(const Stencil& f, const SweepOptions& options) {
    return !(options.limit > 0 && f.kind == Kind::bend);
  }

  std::int64_t constraints() const {
    std::int64_t sum = 0;
    for (const ProjectRows& r : rows_) sum += std::int64_t(r.count) * (r.rows - r.dj);
    return sum;
  }

  std::string names() const {
    std::string names;
    for (const Member& m : members_) {
      const Stencil& f = parts_.stencils[m.index];
      names += " (" + std::to_string(f.di) + "," + std::to_string(f.dj) + ")";
    }
    return (members_.size() == 1 ? "stencil" : "stencils") + names;
  }

  std::size_t bytes() const {
    std::size_t sum = 0;
    for (const Member& m : members_) sum += (m.compliance.size() + m.lanes.size()) * sizeof(float);
    return sum;
  }

  // Sweeps gather corrections, the strain limit changes both.
  Velocities velocities() const {
    return options_.limit > 0 ? Velocities::used : Velocities::left_alone;
  }
  void prepare(double dt) {
    for (std::size_t n = 0; n < members_.size(); ++n) {
      Member& m = members_[n];
      if (options_.limit > 0) rows_[n].dt = float(dt), rows_[n].inverse_dt = float(1 / dt);
      for (std::size_t j = 0; j < m.compliance.size(); ++j)
        m.compliance[j] = compliance_of(parts_, parts_.stencils[m.index], int(j), dt);
    }
  }

  const std::vector<ProjectRows>& rows() const { return rows_; }
  // Forces that last from substep to substep are forgotten.
  void restart() {
    if (options_.limit_sweep == LimitSweep::carry)
      options_.multipliers->clear(0, parts_.lattice.rows);
  }
  void keep(Keeper& keeper) const {
    if (options_.limit_sweep != LimitSweep::carry) return;
    for (const Member& m : members_)
      for (int j = 0; j < parts_.lattice.rows; ++j)
        keeper.sparse(options_.multipliers->row(m.index, j), parts_.lattice.columns);
  }

 private:
  struct Member {
    std::size_t index;
    std::vector<float> compliance;
    AlignedArray<std::int32_t> lanes;
  };

  void add(std::size_t index) {
    Lattice& l = parts_.lattice;
    const Stencil& stencil = parts_.stencils[index];
    Member& m = members_.emplace_back();
    m.index = index;
    ProjectRows& r = rows_.emplace_back();
    r.rows = l.rows;
    r.stride = l.stride;
    r.x = l.x.row(0);
    r.v = l.v.row(0);
    r.w = l.w(0);
    // The second-order substep changes inverse masses on its way.
    if (parts_.scene.solver.order == 1) r.row_w = l.row_inverse_mass.data();
    r.count = stencil.per_row(l.columns);
    r.near = stencil.near();
    r.far = stencil.far();
    r.dj = stencil.dj;
    r.side_by_side = stencil.di != 0 && l.column_width[0] < 1;
    if (stencil.di == 0) r.inverse_width = l.inverse_width.data();
    const bool holds = options_.limit_sweep == LimitSweep::hold;
    r.rest = float(stencil.rest * (1 + (holds ? options_.held : options_.limit)));
    r.most = float(stencil.rest * (1 + options_.limit));
    r.strongest = float(options_.strongest);
    r.weight = options_.compliant || options_.limit > 0
                   ? 1.0f
                   : float(1 / (2 * parts_.cloth.positional_k));
    r.limit = options_.limit > 0 ? options_.limit_sweep : LimitSweep::none;
    if (stencil.links) r.alive = stencil.links->row(0);
    if (options_.tears) {
      r.longest_square = tear_length(parts_.cloth, stencil) * tear_length(parts_.cloth, stencil);
      r.ended = parts_.ended;
    }
    if (options_.compliant) {
      m.compliance.resize(std::size_t(l.rows));
      r.compliance = m.compliance.data();
    }
    if (options_.corrections) r.u = options_.corrections->row(0);
    if (options_.multipliers) r.lambda = options_.multipliers->row(index, 0);
    if (stencil.dj == 0) {
      m.lanes = AlignedArray<std::int32_t>(std::size_t(kColours) * l.stride);
      const int first = options_.backwards ? 1 : 0;
      for (int a = 0; a < r.count; ++a)
        m.lanes[std::size_t((a / stencil.di + first) % kColours) * l.stride + a] = -1;
      r.lanes = m.lanes.data();
    }
  }

  LatticeParts parts_;
  SweepOptions options_;
  std::deque<Member> members_;
  std::vector<ProjectRows> rows_;  // of each member, pointing into it
};

// The stencils of one row offset: along the rows both colours, between rows one.
class GaussSeidel final : public RowStage {
 public:
  GaussSeidel(const LatticeParts& parts, const std::string& name, int dj, int colour,
              std::unique_ptr<ProjectedStencils> stencils)
      : RowStage(name, stencils->names() + (dj > 0 ? ", colour " + std::to_string(colour + 1) : ""),
                 dj, stencils->constraints() / (dj > 0 ? kColours : 1), "constraints"),
        project_(parts.kernels.lattice.project),
        stencils_(std::move(stencils)),
        colour_(colour) {}
  std::size_t bytes() const override { return stencils_->bytes(); }
  void prepare(double dt) override { stencils_->prepare(dt); }
  void restart() override { stencils_->restart(); }
  // Both colours of stencils between rows have the same forces.
  void keep(Keeper& keeper) override {
    if (colour_ == 0) stencils_->keep(keeper);
  }
  Velocities velocities() const override { return stencils_->velocities(); }
  void run(int begin, int end, const Substep&) override {
    const std::vector<ProjectRows>& stencils = stencils_->rows();
    project_({stencils.data(), int(stencils.size()), begin, end, colour_});
  }

 private:
  void (*project_)(const Projection&);
  std::unique_ptr<ProjectedStencils> stencils_;
  int colour_;
};

// Relaxation ω of the summed corrections. n sweeps leave the share p = (1 - ω λ)^n of a mode of the
// constraint system with the eigenvalue λ, relative to its diagonal. Where velocities are made of
// positions the mode follows z² - p (2 z - 1) = 0, so that |z| <= 1 for -1/3 <= p <= 1. The largest
// λ is that of a stretched sheet, which resists in all directions: the greatest Σ 1 - cos(a di + b
// dj) over the stencils. It applies to the part of the system that couples constraints, w_a + w_b:
// compliance needs none, so that a single sweep of small substeps is a spring of the full
// stiffness. Rounded, so that no library's last bit matters.
float relaxation(const std::vector<Stencil>& stencils, int sweeps) {
  constexpr int kAngles = 32, kParts = 256;
  double largest = 1;
  for (int m = 0; m <= kAngles; ++m)
    for (int n = -kAngles; n <= kAngles; ++n) {
      double sum = 0;
      for (const Stencil& f : stencils)
        sum += 1 - std::cos((m * f.di + n * f.dj) * std::numbers::pi / kAngles);
      largest = std::max(largest, sum);
    }
  const double limit = sweeps % 2 == 0 ? 2 : 1 + std::pow(3, -1.0 / sweeps);
  return float(0.95 * std::floor(kParts * limit + 1e-6) / std::ceil(kParts * largest - 1e-6));
}

// The six stencils of a plain cloth in one kernel.
class PlainJacobi final : public PlainRowsStage {
 public:
  PlainJacobi(const LatticeParts& parts, const SweepOptions& options)
      : PlainRowsStage("jacobi", "all stencils, corrections added up and relaxed", parts),
        options_(options),
        relaxation_(relaxation(parts.stencils, parts.scene.solver.iterations)),
        constraints_(std::size_t(parts.lattice.rows) * kPlainStencils) {
    // As weigh_row() has them.
    for (int j = 0; j < parts.lattice.rows; ++j)
      free_inverse_mass_.push_back(float(1 / particle_mass(parts.cloth, 0, j)) *
                                   parts.lattice.column_width[0]);
  }
  std::size_t bytes() const override {
    return PlainRowsStage::bytes() + constraints_.size() * sizeof(JacobiConstants) +
           free_inverse_mass_.size() * sizeof(float);
  }
  void prepare(double dt) override {
    const float share = options_.compliant ? 1.0f : float(2 * parts_.cloth.positional_k);
    weight_ = 1 / (share * relaxation_);
    inverse_dt_ = velocity_gain(parts_.scene.solver, dt);
    for (int j = 0; j < parts_.lattice.rows; ++j)
      for (int f = 0; f < kPlainStencils; ++f)
        constraints_[std::size_t(j) * kPlainStencils + std::size_t(f)] =
            constants_of(parts_.stencils[std::size_t(f)], j, dt);
  }
  Velocities velocities() const override { return Velocities::used; }
  void run(int begin, int end, const Substep& s) override {
    for (int first = begin; first < end;) {
      const float same = alike(first);
      int last = first + 1;
      while (last < end && alike(last) == same) ++last;
      JacobiRows r{};
      fill(r, first, last, s);
      r.alike = same;
      r.constants = constraints_.data();
      for (int f = 0; f < kPlainStencils; ++f)
        r.rest[f] = float(parts_.stencils[std::size_t(f)].rest);
      r.weight = weight_;
      r.inverse_dt = inverse_dt_;
      if (options_.left) r.left = options_.left->row(0);
      parts_.kernels.lattice.jacobi_rows(r);
      first = last;
    }
  }

 private:
  JacobiConstants constants_of(const Stencil& stencil, int j, double dt) const {
    if (j + stencil.dj >= parts_.lattice.rows)
      return {std::numeric_limits<float>::infinity(), 0, 0, 1, 1};
    const float compliance = options_.compliant ? compliance_of(parts_, stencil, j, dt) : 0;
    const float w = free_inverse_mass_[std::size_t(j)] * weight_;
    const float k = 1 / (2 * w + compliance);
    // Where one end, or both, lie at the sides.
    const float one = (2 * w + compliance) / (3 * w + compliance);
    const float both = (2 * w + compliance) / (4 * w + compliance);
    const bool sides = stencil.di != 0 && parts_.lattice.column_width[0] < 1;
    return {compliance, k, k * float(stencil.rest), sides ? one : 1, sides ? both : 1};
  }

  // The inverse mass of everything that row j's constraints join; 0: not all have that of row j, or
  // something is pinned.
  float alike(int j) const {
    if (parts_.scene.solver.order != 1) return 0;  // it changes inverse masses on its way
    const Lattice& l = parts_.lattice;
    const float free = free_inverse_mass_[std::size_t(j)];
    for (int n = j; n <= std::min(j + reach, l.rows - 1); ++n)
      if (l.row_inverse_mass[std::size_t(n)] != free) return 0;
    return free;
  }

  SweepOptions options_;
  float relaxation_;
  std::vector<JacobiConstants> constraints_;
  std::vector<float> free_inverse_mass_;  // of every row's particles, unless pinned [1/kg]
  float weight_ = 1, inverse_dt_ = 0;
};

// Any stencils, one kernel call each.
class Jacobi final : public RowStage {
 public:
  Jacobi(const LatticeParts& parts, const SweepOptions& options, int reach)
      : RowStage("jacobi", "all stencils, corrections added up and relaxed", reach,
                 parts.constraints(), "constraints"),
        parts_(parts),
        options_(options),
        relaxation_(relaxation(parts.stencils, parts.scene.solver.iterations)) {
    for (int dj = 0; dj <= reach; ++dj) stencils_.emplace_back(parts, options, dj);
  }
  void reserve_slots(int slots) override {
    sum_ = Rows((reach + 1) * slots, parts_.lattice.stride);
  }
  std::size_t bytes() const override { return sum_.bytes(); }
  void prepare(double dt) override {
    for (ProjectedStencils& f : stencils_) f.prepare(dt);
  }
  Velocities velocities() const override { return Velocities::used; }
  void start(const Substep& s) override {
    for (int k = 0; k <= reach; ++k)
      zero(sum_.row(s.slot * (reach + 1) + k), parts_.lattice.stride);
  }
  void run(int j, const Substep& s) override {
    Lattice& l = parts_.lattice;
    const auto sum = [&](int row) { return sum_.row(s.slot * (reach + 1) + row % (reach + 1)); };
    for (const ProjectedStencils& stencils : stencils_)
      for (ProjectRows rows : stencils.rows()) {
        if (j + rows.dj >= l.rows) continue;
        rows.weight /= relaxation_;
        parts_.kernels.lattice.jacobi_stencil(rows, j, sum(j), sum(j + rows.dj));
      }
    AdvanceRow a{};
    a.columns = l.columns;
    a.x = l.x.row(j);
    a.v = l.v.row(j);
    a.w = l.w(j);
    a.f = sum(j);
    a.inverse_dt = velocity_gain(parts_.scene.solver, s.dt);
    if (options_.left) a.left = options_.left->row(j);
    parts_.kernels.particles.apply_corrections(a);
  }

 private:
  LatticeParts parts_;
  SweepOptions options_;
  float relaxation_;
  std::deque<ProjectedStencils> stencils_;
  Rows sum_;  // reach+1 rows in turn per slot
};

}  // namespace

SubstepStart start_of(const LatticeParts& parts, double dt) {
  if (parts.scene.solver.order == 2) return {parts.lattice.previous.row(0), {}, 0};
  return {{}, parts.lattice.v.row(0), float(dt)};
}

float compliance_of(const LatticeParts& parts, const Stencil& f, int j, double dt) {
  const double k = f.stiffness * row_factor(parts.cloth, f, j);
  const double h = dt * implicit_share(parts.scene.solver);
  return float(1 / (std::max(k, 1e-12) * h * h));
}

void append_gauss_seidel(const LatticeParts& parts, const SweepOptions& options, Stages& stages) {
  const std::string name = options.limit > 0 ? "strain_limit" : "gauss_seidel";
  Stages sweep;
  for (int dj = 0; dj <= greatest_reach(parts); ++dj)
    for (int colour = 0; colour < (dj > 0 ? kColours : 1); ++colour) {
      auto stencils = std::make_unique<ProjectedStencils>(parts, options, dj);
      if (stencils->constraints() > 0)
        sweep.push_back(
            std::make_unique<GaussSeidel>(parts, name, dj, colour, std::move(stencils)));
    }
  if (options.backwards) std::ranges::reverse(sweep);
  std::ranges::move(sweep, std::back_inserter(stages));
}

// What the forces hold lies below the limit by the share that a sudden load may take until they have met it. One
// constraint alone may have to bear the whole sheet; no force lasts that is much more than that.
void append_held_limit(const LatticeParts& parts, Multipliers& forces, Stages& stages) {
  constexpr double kHeld = 0.95;  // of the limit
  constexpr int kSweeps = 4;
  constexpr double kWeights = 2, kGravity = 9.81;  // of the sheet; m/s², where there is less
  double mass = 0;
  for (int j = 0; j < parts.lattice.rows; ++j)
    for (int i = 0; i < parts.lattice.columns; ++i) mass += particle_mass(parts.cloth, i, j);
  SweepOptions options;
  options.multipliers = &forces;
  options.limit = parts.cloth.strain_limit;
  options.held = kHeld * options.limit;
  options.strongest = kWeights * mass * std::max(greatest_gravity(parts.scene), kGravity);
  const auto append = [&](LimitSweep sweep) {
    options.limit_sweep = sweep;
    append_gauss_seidel(parts, options, stages);
  };
  append(LimitSweep::carry);
  for (int n = 0; n < kSweeps; ++n) append(LimitSweep::hold);
  append(LimitSweep::settle);
}

std::unique_ptr<RowStage> make_jacobi(const LatticeParts& parts, const SweepOptions& options) {
  if (is_plain(parts) && !options.multipliers) return std::make_unique<PlainJacobi>(parts, options);
  return std::make_unique<Jacobi>(parts, options, greatest_reach(parts));
}

}  // namespace weft::physics
