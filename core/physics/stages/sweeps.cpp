// Stages "gauss_seidel" and "jacobi": one sweep of projections over all constraint families.
//
// Gauss–Seidel goes family by family and, within one, colour by colour: constraints a of one row
// alternate by a/|di|, those between rows by j/dj, so that the constraints of a colour are disjoint
// and may be solved side by side. The order depends on nothing but the scene.
#include "physics/stages/stages.h"

namespace weft::physics {
namespace {

constexpr int kColours = 2;

// One family of a sweep as its kernel takes it, with the compliance of every row.
class ProjectedFamily {
 public:
  ProjectedFamily(const ClothParts& parts, const SweepOptions& options, std::size_t index)
      : parts_(parts), options_(options), family_(parts.families[index]), index_(index) {
    if (options.compliant) compliance_.resize(parts.lattice.rows);
  }

  const Family& family() const { return family_; }

  void prepare(double dt) {
    rows_ = {};
    Lattice& l = parts_.lattice;
    rows_.rows = l.rows;
    rows_.stride = l.stride;
    rows_.x = l.x.row(0);
    rows_.v = l.v.row(0);
    rows_.w = l.w(0);
    rows_.count = family_.per_row(l.columns);
    rows_.near = family_.near();
    rows_.far = family_.far();
    rows_.dj = family_.dj;
    rows_.rest = float(family_.rest);
    rows_.weight = 1;
    if (family_.links) rows_.alive = family_.links->row(0);
    if (options_.limit > 0) {
      rows_.rest = float(family_.rest * (1 + options_.limit));
      rows_.limit = true;
      rows_.inverse_dt = float(1 / dt);
    } else if (options_.compliant) {
      for (int j = 0; j < l.rows; ++j) compliance_[j] = compliance_of(parts_, family_, j, dt);
      rows_.compliance = compliance_.data();
      // The velocity gains each correction as computed: the difference of rounded positions would
      // be off by their rounding over dt, which a small substep's force does not outweigh.
      rows_.inverse_dt = float(1 / (dt * implicit_share(parts_.scene.solver)));
      if (options_.multipliers) rows_.lambda = options_.multipliers->row(index_, 0);
    } else {
      rows_.weight = float(1 / (2 * parts_.cloth.positional_k));
    }
  }

  ProjectRows rows(int begin, int end) const {
    ProjectRows r = rows_;
    r.begin = begin;
    r.end = end;
    return r;
  }

 private:
  ClothParts parts_;
  SweepOptions options_;
  Family family_;
  std::size_t index_;
  std::vector<float> compliance_;
  ProjectRows rows_{};
};

std::int64_t constraints_of(const ClothParts& parts, const Family& f) {
  return std::int64_t(f.per_row(parts.lattice.columns)) * (parts.lattice.rows - f.dj);
}

std::string offset_text(const Family& f) {
  return "(" + std::to_string(f.di) + "," + std::to_string(f.dj) + ")";
}

// Constraints along the rows, one colour after the other.
class AlongRows final : public RowStage {
 public:
  AlongRows(const ClothParts& parts, const SweepOptions& options, std::size_t index,
            const std::string& name)
      : RowStage(name, "family " + offset_text(parts.families[index]), 0,
                 constraints_of(parts, parts.families[index]), "constraints"),
        project_(parts.kernels.project),
        family_(parts, options, index),
        lanes_(std::size_t(kColours) * parts.lattice.stride) {
    const Family& f = family_.family();
    for (int a = 0; a < f.per_row(parts.lattice.columns); ++a)
      lanes_[std::size_t(a / f.di % kColours) * parts.lattice.stride + a] = -1;
  }
  void prepare(double dt) override { family_.prepare(dt); }
  void run(int begin, int end, const Substep&) override {
    ProjectRows p = family_.rows(begin, end);
    p.lanes = lanes_.data();
    project_(p);
  }

 private:
  void (*project_)(const ProjectRows&);
  ProjectedFamily family_;
  AlignedArray<std::int32_t> lanes_;
};

// Constraints between rows j and j+dj, for the rows of one colour.
class BetweenRows final : public RowStage {
 public:
  BetweenRows(const ClothParts& parts, const SweepOptions& options, std::size_t index, int colour,
              const std::string& name)
      : RowStage(name,
                 "family " + offset_text(parts.families[index]) + ", colour " +
                     std::to_string(colour + 1),
                 parts.families[index].dj, constraints_of(parts, parts.families[index]) / kColours,
                 "constraints"),
        project_(parts.kernels.project),
        family_(parts, options, index),
        colour_(colour) {}
  void prepare(double dt) override { family_.prepare(dt); }
  void run(int begin, int end, const Substep&) override {
    ProjectRows p = family_.rows(begin, end);
    p.colour = colour_;
    project_(p);
  }

 private:
  void (*project_)(const ProjectRows&);
  ProjectedFamily family_;
  int colour_;
};

// Relaxation of the summed corrections. The largest eigenvalue of the constraint system, relative
// to its diagonal, is at most half the constraints at a particle for sheets made of these families;
// 2.7/n keeps the sweep convergent, 0.9 is the bound of a single chain. It applies to the part of the
// system that couples constraints, w_a + w_b: compliance needs none, so that a single sweep of small
// substeps is a spring of the full stiffness.
float relaxation(std::size_t families) { return std::min(0.9f, 2.7f / float(2 * families)); }

class Jacobi final : public RowStage {
 public:
  Jacobi(const ClothParts& parts, const SweepOptions& options, int reach)
      : RowStage("jacobi", "all families, corrections added up and relaxed", reach,
                 parts.constraints(), "constraints"),
        parts_(parts),
        keeps_velocity_(options.compliant) {
    for (std::size_t f = 0; f < parts.families.size(); ++f)
      families_.emplace_back(parts, options, f);
  }
  void reserve_slots(int slots) override {
    sum_ = Rows((reach + 1) * slots, parts_.lattice.stride);
  }
  std::size_t bytes() const override { return sum_.bytes(); }
  void prepare(double dt) override {
    for (ProjectedFamily& f : families_) f.prepare(dt);
  }
  void run(int j, const Substep& s) override {
    Lattice& l = parts_.lattice;
    const auto sum = [&](int row) { return sum_.row(s.slot * (reach + 1) + row % (reach + 1)); };
    for (const ProjectedFamily& f : families_) {
      const int dj = f.family().dj;
      if (j + dj >= l.rows) continue;
      ProjectRows p = f.rows(j, j + 1);
      p.weight /= relaxation(families_.size());
      parts_.kernels.project_jacobi(p, j, sum(j), sum(j + dj));
    }
    AdvanceRow a{};
    a.columns = l.columns;
    a.x = l.x.row(j);
    a.v = l.v.row(j);
    a.f = sum(j);
    a.inverse_dt =
        keeps_velocity_ ? float(1 / (s.dt * implicit_share(parts_.scene.solver))) : 0.0f;
    parts_.kernels.apply_corrections(a);
  }

 private:
  ClothParts parts_;
  bool keeps_velocity_;
  std::vector<ProjectedFamily> families_;
  Rows sum_;  // reach+1 rows in turn per slot
};

}  // namespace

float compliance_of(const ClothParts& parts, const Family& f, int j, double dt) {
  const double k = f.stiffness * gradient_factor(parts.cloth, j, f.dj);
  const double h = dt * implicit_share(parts.scene.solver);
  return float(1 / (std::max(k, 1e-12) * h * h));
}

void append_gauss_seidel(const ClothParts& parts, const SweepOptions& options,
                         Stages& stages) {
  const std::string name = options.limit > 0 ? "strain_limit" : "gauss_seidel";
  for (std::size_t index = 0; index < parts.families.size(); ++index) {
    // Bend constraints join second neighbours; the limit is one on the cloth's own edges.
    if (options.limit > 0 && parts.families[index].kind == Kind::bend) continue;
    if (parts.families[index].dj == 0) {
      stages.push_back(std::make_unique<AlongRows>(parts, options, index, name));
      continue;
    }
    for (int colour = 0; colour < kColours; ++colour)
      stages.push_back(std::make_unique<BetweenRows>(parts, options, index, colour, name));
  }
}

std::unique_ptr<RowStage> make_jacobi(const ClothParts& parts, const SweepOptions& options) {
  int reach = 0;
  for (const Family& f : parts.families) reach = std::max(reach, f.dj);
  return std::make_unique<Jacobi>(parts, options, reach);
}

}  // namespace weft::physics
