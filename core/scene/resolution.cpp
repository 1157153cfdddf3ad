// Grids of other resolutions (weft/resolution.h).
#include "weft/resolution.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <stdexcept>

#include "scene/json_text.h"

namespace weft {
namespace {

// Where a particle of one grid lies on another, in its columns or rows.
double place(int n, int intervals, int others) {
  return double(n) * others / intervals;
}

std::optional<Pin> between(const Pin& a, const Pin& b, double share) {
  if (a.keys.size() != b.keys.size() || a.rotate != b.rotate || a.follow != b.follow) return {};
  Pin pin = a;
  for (std::size_t n = 0; n < a.keys.size(); ++n) {
    if (a.keys[n].time != b.keys[n].time) return {};
    pin.keys[n].position =
        plus(times(a.keys[n].position, 1 - share), times(b.keys[n].position, share));
  }
  return pin;
}

// How far two paths are apart at most [m].
double apart(const Pin& a, const Pin& b) {
  if (!between(a, b, 0)) return std::numeric_limits<double>::infinity();
  double most = 0;
  for (std::size_t n = 0; n < a.keys.size(); ++n)
    most = std::max(most, distance(a.keys[n].position, b.keys[n].position));
  return most;
}

// The held particles of one grid, and what they hold on another.
class HeldOnAnother {
 public:
  HeldOnAnother(const Cloth& from, Cloth& to)
      : from_(from),
        to_(to),
        mu_(from.grid.nx - 1),
        mv_(from.grid.ny - 1),
        nu_(to.grid.nx - 1),
        nv_(to.grid.ny - 1),
        pins_(single_pins(from)),
        at_(std::size_t(particle_count(from)), nullptr),
        taken_(std::size_t(particle_count(to))),
        spacing_(std::min(spacing_u(to.grid), spacing_v(to.grid))) {
    for (const Pin& pin : pins_) at_[index(from_, pin.i, pin.j)] = &pin;
    to_.pins.clear();
  }

  // What lies between held neighbours is held by all of them, the rest by the nearest.
  void put() {
    for (const Pin& pin : pins_) patch(pin);
    for (const Pin& pin : pins_) {
      if (const Pin* right = at(pin.i + 1, pin.j)) line(pin, *right);
      if (const Pin* below = at(pin.i, pin.j + 1)) line(pin, *below);
    }
    for (const Pin& pin : pins_) {
      const Pin& by = put(column(pin.i), row(pin.j), pin, pin.i, pin.j);
      const Pin wanted = moved(by.i, by.j, pin, pin.i, pin.j);
      if (apart(by, wanted) > kNear * spacing_ && !as_neighbours(pin)) ++dropped_;
      // Within a line others stand for it.
      if (!at(pin.i - 1, pin.j) || !at(pin.i + 1, pin.j))
        off(place(pin.i, mu_, nu_) - column(pin.i));
      if (!at(pin.i, pin.j - 1) || !at(pin.i, pin.j + 1)) off(place(pin.j, mv_, nv_) - row(pin.j));
    }
  }

  // The farthest that something held lies from where it was, in the new grid's spacings.
  double farthest() const { return farthest_; }
  // How many paths nothing on the new grid has, to 0.005 of its spacings.
  int dropped() const { return dropped_; }

  static constexpr double kNear = 0.005;  // of a spacing: what is less far off is in its place

 private:
  static std::size_t index(const Cloth& cloth, int i, int j) {
    return std::size_t(particle_number(cloth.grid, i, j));
  }
  int column(int i) const { return int(std::lround(place(i, mu_, nu_))); }
  int row(int j) const { return int(std::lround(place(j, mv_, nv_))); }
  const Pin* at(int i, int j) const {
    return i < 0 || j < 0 || i > mu_ || j > mv_ ? nullptr : at_[index(from_, i, j)];
  }

  void off(double spacings) { farthest_ = std::max(farthest_, std::abs(spacings)); }

  // Paths are of places; the particle starts elsewhere than (i, j) of the old grid by as much as the grids differ.
  Pin moved(int column, int row, Pin pin, double i, double j) const {
    const double du = place(column, nu_, mu_) - i, dv = place(row, nv_, mv_) - j;
    const Vec3 by = plus(times(from_.grid.u, du / mu_), times(from_.grid.v, dv / mv_));
    for (Key& key : pin.keys) key.position = plus(key.position, by);
    pin.i = column, pin.j = row;
    return pin;
  }

  // What holds the particle: this pin, unless another was first.
  const Pin& put(int column, int row, const Pin& pin, double i, double j) {
    std::size_t& taken = taken_[index(to_, column, row)];
    if (taken == 0) {
      to_.pins.push_back(moved(column, row, pin, i, j));
      taken = to_.pins.size();
    }
    return to_.pins[taken - 1];
  }

  // Whether its neighbours on a line say what its path is.
  bool as_neighbours(const Pin& pin) const {
    const auto middle = [&](const Pin* a, const Pin* b) {
      const std::optional<Pin> path = a && b ? between(*a, *b, 0.5) : std::nullopt;
      return path && apart(*path, pin) <= kNear * spacing_;
    };
    return middle(at(pin.i - 1, pin.j), at(pin.i + 1, pin.j)) ||
           middle(at(pin.i, pin.j - 1), at(pin.i, pin.j + 1));
  }

  // The first of the new grid's columns or rows that is no less than n of the old one's.
  int column_from(int n) const { return (n * nu_ + mu_ - 1) / mu_; }
  int row_from(int n) const { return (n * nv_ + mv_ - 1) / mv_; }

  // All from one neighbour to the other, its right or lower one.
  void line(const Pin& a, const Pin& b) {
    const bool across = b.i > a.i;
    const int first = across ? column_from(a.i) : row_from(a.j);
    for (int n = first; across ? n * mu_ <= b.i * nu_ : n * mv_ <= b.j * nv_; ++n) {
      const double share = across ? place(n, nu_, mu_) - a.i : place(n, nv_, mv_) - a.j;
      const std::optional<Pin> pin = between(a, b, share);
      if (pin && across) put(n, row(a.j), *pin, a.i + share, a.j);
      if (pin && !across) put(column(a.i), n, *pin, a.i, a.j + share);
    }
  }

  // What lies within the cell of which `pin` is the first corner, if all four are held.
  void patch(const Pin& pin) {
    const Pin *right = at(pin.i + 1, pin.j), *below = at(pin.i, pin.j + 1),
              *far = at(pin.i + 1, pin.j + 1);
    if (!right || !below || !far) return;
    for (int j = row_from(pin.j); j * mv_ <= (pin.j + 1) * nv_; ++j)
      for (int i = column_from(pin.i); i * mu_ <= (pin.i + 1) * nu_; ++i) {
        const double su = place(i, nu_, mu_) - pin.i, sv = place(j, nv_, mv_) - pin.j;
        const std::optional<Pin> upper = between(pin, *right, su),
                                 lower = between(*below, *far, su);
        if (!upper || !lower) continue;
        if (const std::optional<Pin> here = between(*upper, *lower, sv))
          put(i, j, *here, pin.i + su, pin.j + sv);
      }
  }

  const Cloth& from_;
  Cloth& to_;
  int mu_, mv_, nu_, nv_;  // intervals
  std::vector<Pin> pins_;
  std::vector<const Pin*> at_;  // of every particle of the old grid; null: free
  std::vector<std::size_t>
      taken_;       // of every particle of the new one: its pin's number from 1, or 0
  double spacing_;  // the least of the new grid [m]
  double farthest_ = 0;
  int dropped_ = 0;
};

// Masses between those of the old grid's particles, of the same sum.
std::vector<double> shared_anew(const Cloth& from, const Grid& to) {
  std::vector<double> masses;
  const int mu = from.grid.nx - 1, mv = from.grid.ny - 1;
  double sum = 0, asked = 0;
  for (const double mass : from.masses) asked += mass;
  for (int j = 0; j < to.ny; ++j)
    for (int i = 0; i < to.nx; ++i) {
      const double a = place(i, to.nx - 1, mu), b = place(j, to.ny - 1, mv);
      const int i0 = std::min(int(a), mu - 1), j0 = std::min(int(b), mv - 1);
      const auto mass = [&](int di, int dj) { return particle_mass(from, i0 + di, j0 + dj); };
      const double su = a - i0, sv = b - j0;
      masses.push_back((1 - sv) * ((1 - su) * mass(0, 0) + su * mass(1, 0)) +
                       sv * ((1 - su) * mass(0, 1) + su * mass(1, 1)));
      sum += masses.back();
    }
  for (double& mass : masses) mass *= asked / sum;
  return masses;
}

}  // namespace

Intervals intervals_of_pins(const Cloth& cloth) {
  const int mu = cloth.grid.nx - 1, mv = cloth.grid.ny - 1;
  int u = mu, v = mv;
  for (const Pin& pin : single_pins(cloth)) u = std::gcd(u, pin.i), v = std::gcd(v, pin.j);
  return {mu / u, mv / v};
}

RegriddedCloth with_intervals(const Cloth& cloth, const Intervals& intervals) {
  constexpr int kMost = 4095;
  if (cloth.mesh.given() || std::min(intervals.u, intervals.v) < 1 ||
      std::max(intervals.u, intervals.v) > kMost)
    throw std::invalid_argument("not a grid, or not 1 to 4095 intervals");
  RegriddedCloth result{cloth, {}};
  Cloth& to = result.cloth;
  to.grid.nx = intervals.u + 1, to.grid.ny = intervals.v + 1;
  if (to.grid == cloth.grid) return result;
  const double fewer = double(particle_count(cloth)) / particle_count(to);
  to.particle_mass = cloth.particle_mass * fewer;
  if (!cloth.masses.empty()) to.masses = shared_anew(cloth, to.grid);
  for (CutLine& line : to.cuts)
    for (std::array<double, 2>& point : line)
      point = {point[0] * intervals.u / (cloth.grid.nx - 1),
               point[1] * intervals.v / (cloth.grid.ny - 1)};
  HeldOnAnother held(cloth, to);
  held.put();
  if (held.farthest() > HeldOnAnother::kNear)
    result.notes.push_back("what is held lies up to " +
                           text::number_words(std::round(100 * held.farthest()) / 100) +
                           " spacings of its grid from its place");
  if (held.dropped() > 0)
    result.notes.push_back(
        "the paths of " + std::to_string(held.dropped()) +
        " held particles are left out: others hold the same particles of its grid");
  return result;
}

}  // namespace weft
