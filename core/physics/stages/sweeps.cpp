// Stages "gauss_seidel" and "jacobi": one sweep of projections over all constraint families.
//
// Gauss–Seidel goes family by family and, within one, colour by colour: constraints a of one row
// alternate by a/|di|, those between rows by j/dj, so that the constraints of a colour are disjoint
// and may be solved side by side. The order depends on nothing but the scene.
#include "physics/stages/stages.h"

namespace weft::physics {
namespace {

constexpr int kColours = 2;

// Compliance 1/(k dt²) [1/kg] of a family's constraints in row j.
float compliance_of(const ClothParts& parts, const Family& f, int j, double dt) {
  const double k = f.stiffness * gradient_factor(parts.cloth, j, f.dj);
  return float(1 / (std::max(k, 1e-12) * dt * dt));
}

ProjectRow project_row(const ClothParts& parts, const SweepOptions& o, std::size_t index, int j,
                       const Substep& s) {
  const Family& f = parts.families[index];
  ProjectRow p{};
  p.rows = family_row(parts.lattice, f, j);
  p.rest = float(f.rest);
  p.share = 1;
  if (o.limit > 0) {
    p.limit = float(f.rest * (1 + o.limit));
    p.inverse_dt = float(1 / s.dt);
  } else if (o.compliant) {
    p.compliance = compliance_of(parts, f, j, s.dt);
    if (o.multipliers) p.lambda = o.multipliers->row(index, j);
  } else {
    p.share = float(2 * parts.cloth.positional_k);
  }
  return p;
}

std::int64_t constraints_of(const ClothParts& parts, const Family& f) {
  return std::int64_t(f.per_row(parts.lattice.columns)) * (parts.lattice.rows - f.dj);
}

std::string offset_text(const Family& f) {
  return "(" + std::to_string(f.di) + "," + std::to_string(f.dj) + ")";
}

// Constraints along the rows: both colours of a row, one after the other.
class AlongRows final : public RowStage {
 public:
  AlongRows(const ClothParts& parts, const SweepOptions& options, std::size_t index,
            const std::string& name)
      : RowStage(name, "family " + offset_text(parts.families[index]), 0,
                 constraints_of(parts, parts.families[index]), "constraints"),
        parts_(parts),
        options_(options),
        index_(index),
        lanes_(std::size_t(kColours) * parts.lattice.stride) {
    const Family& f = parts.families[index];
    for (int a = 0; a < f.per_row(parts.lattice.columns); ++a)
      lanes_[std::size_t(a / f.di % kColours) * parts.lattice.stride + a] = -1;
  }
  void run(int j, const Substep& s) override {
    ProjectRow p = project_row(parts_, options_, index_, j, s);
    for (int colour = 0; colour < kColours; ++colour) {
      p.lanes = lanes_.data() + std::size_t(colour) * parts_.lattice.stride;
      parts_.kernels.project(p);
    }
  }

 private:
  ClothParts parts_;
  SweepOptions options_;
  std::size_t index_;
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
        parts_(parts),
        options_(options),
        index_(index),
        colour_(colour) {}
  void run(int j, const Substep& s) override {
    if (j / reach % kColours != colour_ || j + reach >= parts_.lattice.rows) return;
    parts_.kernels.project(project_row(parts_, options_, index_, j, s));
  }

 private:
  ClothParts parts_;
  SweepOptions options_;
  std::size_t index_;
  int colour_;
};

// Relaxation of the summed corrections. The largest eigenvalue of the constraint system, relative
// to its diagonal, is at most half the constraints at a particle for sheets made of these families;
// 2.7/n keeps the sweep convergent, 0.9 is the bound of a single chain.
float relaxation(std::size_t families) { return std::min(0.9f, 2.7f / float(2 * families)); }

class Jacobi final : public RowStage {
 public:
  Jacobi(const ClothParts& parts, const SweepOptions& options, int reach)
      : RowStage("jacobi", "all families, corrections added up and relaxed", reach,
                 parts.constraints(), "constraints"),
        parts_(parts),
        options_(options) {}
  void reserve_slots(int slots) override {
    sum_ = Rows((reach + 1) * slots, parts_.lattice.stride);
  }
  std::size_t bytes() const override { return sum_.bytes(); }
  void run(int j, const Substep& s) override {
    Lattice& l = parts_.lattice;
    const auto sum = [&](int row) { return sum_.row(s.slot * (reach + 1) + row % (reach + 1)); };
    for (std::size_t index = 0; index < parts_.families.size(); ++index) {
      const Family& f = parts_.families[index];
      if (j + f.dj >= l.rows) continue;
      ProjectRow p = project_row(parts_, options_, index, j, s);
      p.rows.f = sum(j);
      p.rows.f_far = sum(j + f.dj);
      p.share *= relaxation(parts_.families.size());
      parts_.kernels.project_jacobi(p);
    }
    AdvanceRow a{};
    a.columns = l.columns;
    a.x = l.x.row(j);
    a.f = sum(j);
    parts_.kernels.apply_corrections(a);
  }

 private:
  ClothParts parts_;
  SweepOptions options_;
  Rows sum_;  // reach+1 rows in turn per slot
};

}  // namespace

void append_gauss_seidel(const ClothParts& parts, const SweepOptions& options,
                         Stages& stages) {
  const std::string name = options.limit > 0 ? "strain_limit" : "gauss_seidel";
  for (std::size_t index = 0; index < parts.families.size(); ++index) {
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
