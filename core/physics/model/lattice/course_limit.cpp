// Stage "strain_limit" in the course's order (seeds 001 and 004): point after point, row by row, the springs
// to those before it: left, above, above to the left and to the right, two to the left, two above. What is
// too long is shortened at once, by both ends, or by the free one alone.
#include <algorithm>
#include <cmath>

#include "physics/model/lattice/stages.h"

namespace weft::physics {
namespace {

constexpr float kRounding = 1e-6f;  // of a squared length, between the kernel's and the one here

class CourseLimit final : public RowStage {
 public:
  explicit CourseLimit(const LatticeParts& parts)
      : RowStage("strain_limit", "all constraints, one after the other in the course's order",
                 greatest_reach(parts), parts.constraints(), "constraints"),
        parts_(parts) {
    for (const Stencil& f : parts.stencils)
      longest_.push_back(float(f.rest * (1 + parts.cloth.strain_limit)));
  }

  // The springs of a row's points join it to `reach` rows before it.
  void run(int j, const Substep& s) override {
    const int last = std::min(j + reach, parts_.lattice.rows - 1);
    for (int row = j == 0 ? 0 : j + reach; row <= last; ++row)
      if (any_too_long(row)) shorten(row, float(1 / s.dt));
  }

 private:
  bool any_too_long(int row) const {
    for (std::size_t n = 0; n < longest_.size(); ++n) {
      const Stencil& f = parts_.stencils[n];
      if (row < f.dj) continue;
      const FarRows ends = far_rows(f, parts_.lattice.x, parts_.lattice.columns, row - f.dj);
      const float longest = longest_[n] * longest_[n] * (1 - kRounding);
      if (parts_.kernels.greatest_square(ends) > longest) return true;
    }
    return false;
  }

  void shorten(int row, float inverse_dt) {
    for (int i = 0; i < parts_.lattice.columns; ++i)
      for (std::size_t n = 0; n < longest_.size(); ++n) {
        const Stencil& f = parts_.stencils[n];
        const int a = i - f.far(), j = row - f.dj;
        if (j < 0 || a < 0 || a >= f.per_row(parts_.lattice.columns) || !f.alive(j, a)) continue;
        shorten({j, a + f.near()}, {row, i}, longest_[n], inverse_dt);
      }
  }

  void shorten(Particles::Place a, Particles::Place b, float longest, float inverse_dt) {
    Lattice& l = parts_.lattice;
    const float wa = l.w(a.j, a.i), wb = l.w(b.j, b.i);
    float e[3];
    for (int k = 0; k < 3; ++k) e[k] = l.x.at(k, b.j, b.i) - l.x.at(k, a.j, a.i);
    const float square = e[0] * e[0] + e[1] * e[1] + e[2] * e[2];
    if (!(square > longest * longest) || wa + wb == 0) return;
    const float share = (1 - longest / std::sqrt(square)) / (wa + wb);
    for (int k = 0; k < 3; ++k) {
      const float by = e[k] * share;
      l.x.at(k, a.j, a.i) += wa * by;
      l.v.at(k, a.j, a.i) += wa * by * inverse_dt;
      l.x.at(k, b.j, b.i) -= wb * by;
      l.v.at(k, b.j, b.i) -= wb * by * inverse_dt;
    }
  }

  LatticeParts parts_;
  std::vector<float> longest_;  // of each stencil [m]
};

}  // namespace

std::unique_ptr<RowStage> make_course_limit(const LatticeParts& parts) {
  return std::make_unique<CourseLimit>(parts);
}

}  // namespace weft::physics
