// How far lines are drawn out that sweeps solve as a whole. A single constraint that is long, beside a pin say, hardly
// pulls at its line: the solution (1/k + dt² L/m) λ = C of lengths C, with L of neighbours' differences, spreads that
// over √(k dt²/m) constraints, by as much less.
#pragma once

#include <algorithm>
#include <optional>

namespace weft::physics {

class StrainInLine {
 public:
  // `spread`: of one constraint, over so many.
  explicit StrainInLine(double spread) : share_(1 / (1 + spread)) {}

  // A line of so many constraints. strain(n): |e|/l - 1, or nothing where it has torn.
  template <class Strain>
  void look(int count, Strain&& strain) {
    double there = 0, back = 0;
    for (int n = 0; n < count; ++n) {
      follow(there, strain(n));
      follow(back, strain(count - 1 - n));
    }
  }
  double greatest() const { return greatest_; }

 private:
  void follow(double& spread, const std::optional<double>& strain) {
    spread = strain ? spread + (*strain - spread) * share_ : 0;
    greatest_ = std::max(greatest_, spread);
  }

  double share_, greatest_ = 0;
};

}  // namespace weft::physics
