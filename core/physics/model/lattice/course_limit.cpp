// Stage "strain_limit" in the course's order (seeds 001 and 004): point after point, row by row, the springs
// to those before it: left, above, above to the left and to the right, two to the left, two above. What is
// too long is shortened at once, by both ends, or by the free one alone.
//
// That is one after the other, but most springs are not too long. A row's springs are measured before, many
// side by side; then only those points are gone through which have one that is too long, or may have got one
// because a point before them in the row was moved. What is passed over would not have changed.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "physics/model/lattice/stages.h"

namespace weft::physics {
namespace {

constexpr float kRounding = 1e-6f;  // of a squared length, between the kernel's and those here

class CourseLimit final : public RowStage {
 public:
  explicit CourseLimit(const LatticeParts& parts)
      : RowStage("strain_limit", "all constraints, one after the other in the course's order",
                 greatest_reach(parts), parts.constraints(), "constraints"),
        parts_(parts) {
    for (const Stencil& f : parts.stencils) {
      longest_.push_back(float(f.rest * (1 + parts.cloth.strain_limit)));
      across_ = std::max(across_, std::abs(f.di));
    }
  }
  std::size_t bytes() const override { return looked_at_.size(); }

  // The springs of a row's points join it to `reach` rows before it.
  void run(int j, const Substep& s) override {
    const int last = std::min(j + reach, parts_.lattice.rows - 1);
    std::uint8_t* const look = looked_at_.data() + std::size_t(s.slot) * places();
    for (int row = j == 0 ? 0 : j + reach; row <= last; ++row)
      if (find_too_long(row, look)) shorten(row, look, float(1 / s.dt));
  }

 private:
  void reserve_slots(int slots) override { looked_at_.resize(std::size_t(slots) * places()); }
  // Points of a row, and as many more as a point's move may concern.
  std::size_t places() const { return std::size_t(parts_.lattice.columns + 2 * across_); }

  // m²
  static float square(const FarRows& springs, int a) {
    const float x = springs.far.x[a] - springs.near.x[a], y = springs.far.y[a] - springs.near.y[a],
                z = springs.far.z[a] - springs.near.z[a];
    return x * x + y * y + z * z;
  }

  // Marks the points of springs that are too long; whether there are any.
  bool find_too_long(int row, std::uint8_t* look) const {
    std::fill_n(look, places(), std::uint8_t{0});
    bool any = false;
    for (std::size_t n = 0; n < longest_.size(); ++n) {
      const Stencil& f = parts_.stencils[n];
      if (row < f.dj) continue;
      const FarRows all = far_rows(f, parts_.lattice.x, parts_.lattice.columns, row - f.dj);
      const float longest = longest_[n] * longest_[n] * (1 - kRounding);
      if (!(parts_.kernels.lattice.greatest_square(all) > longest)) continue;
      any = true;
      for (int a = 0; a < all.count; ++a)
        look[a + f.far()] |= std::uint8_t(square(all, a) > longest);
    }
    return any;
  }

  // A point's springs reach as many columns to either side as those that others move.
  void shorten(int row, std::uint8_t* look, float inverse_dt) {
    for (int i = 0; i < parts_.lattice.columns; ++i)
      if (look[i] && shorten_at(row, i, inverse_dt))
        std::fill_n(look + i + 1, 2 * across_, std::uint8_t{1});
  }

  bool shorten_at(int row, int i, float inverse_dt) {
    bool moved = false;
    for (std::size_t n = 0; n < longest_.size(); ++n) {
      const Stencil& f = parts_.stencils[n];
      const int a = i - f.far(), j = row - f.dj;
      if (j < 0 || a < 0 || a >= f.per_row(parts_.lattice.columns) || !f.alive(j, a)) continue;
      moved |= shorten({j, a + f.near()}, {row, i}, longest_[n], inverse_dt);
    }
    return moved;
  }

  // Whether it was too long.
  bool shorten(Particles::Place a, Particles::Place b, float longest, float inverse_dt) {
    Lattice& l = parts_.lattice;
    const float wa = l.w(a.j, a.i), wb = l.w(b.j, b.i);
    float e[3];
    for (int k = 0; k < 3; ++k) e[k] = l.x.at(k, b.j, b.i) - l.x.at(k, a.j, a.i);
    const float square = e[0] * e[0] + e[1] * e[1] + e[2] * e[2];
    if (!(square > longest * longest) || wa + wb == 0) return false;
    const float share = (1 - longest / std::sqrt(square)) / (wa + wb);
    for (int k = 0; k < 3; ++k) {
      const float by = e[k] * share;
      l.x.at(k, a.j, a.i) += wa * by;
      l.v.at(k, a.j, a.i) += wa * by * inverse_dt;
      l.x.at(k, b.j, b.i) -= wb * by;
      l.v.at(k, b.j, b.i) -= wb * by * inverse_dt;
    }
    return true;
  }

  LatticeParts parts_;
  std::vector<float> longest_;           // of each stencil [m]
  int across_ = 0;                       // columns that a constraint spans, at most
  std::vector<std::uint8_t> looked_at_;  // points of the row at hand, by slot
};

}  // namespace

std::unique_ptr<RowStage> make_course_limit(const LatticeParts& parts) {
  return std::make_unique<CourseLimit>(parts);
}

}  // namespace weft::physics
