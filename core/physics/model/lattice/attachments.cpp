// Stage "tethers": no free particle is farther from its pins than the sheet between them is long.
//
// The sheet is a flat parallelogram at rest, so the distance over it is the straight one on the
// grid. Of all pins a particle is tethered to the nearest in each of the four quadrants around it:
// pins on different sides hold it in different directions, and one behind a nearer pin of the same
// quadrant adds little. For nearly inextensible cloth only: real stretch would be taken back.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "physics/kernels/second_order.h"
#include "physics/model/lattice/stages.h"
#include "physics/model/lattice/tearing.h"
#include "physics/model/path.h"

namespace weft::physics {
namespace {

constexpr float kFree = 1e18f;  // m; the reach of a particle without a tether

struct Place {
  int i = -1, j = -1;
  bool operator==(const Place&) const = default;
};

// Of the distance over the sheet [m²].
double squared_distance(const Grid& g, const Place& p, int i, int j) {
  double sum = 0;
  for (int k = 0; k < 3; ++k) {
    const double e = g.u[k] / (g.nx - 1) * (p.i - i) + g.v[k] / (g.ny - 1) * (p.j - j);
    sum += e * e;
  }
  return sum;
}

// The nearest pin of one quadrant for every particle, handed on from neighbour to neighbour.
std::vector<Place> nearest(const LatticeParts& parts, int side_i, int side_j) {
  const Lattice& l = parts.lattice;
  std::vector<Place> best(std::size_t(l.columns) * l.rows);
  for (const Pin& pin : parts.cloth.pins)
    best[std::size_t(pin.j) * l.columns + pin.i] = {pin.i, pin.j};
  const auto squared = [&](const Place& p, int i, int j) {
    return p.i < 0 ? std::numeric_limits<double>::infinity()
                   : squared_distance(parts.cloth.grid, p, i, j);
  };
  for (int b = 0; b < l.rows; ++b)
    for (int a = 0; a < l.columns; ++a) {
      const int i = side_i > 0 ? l.columns - 1 - a : a, j = side_j > 0 ? l.rows - 1 - b : b;
      Place& here = best[std::size_t(j) * l.columns + i];
      for (const auto& [di, dj] :
           {std::array{side_i, 0}, std::array{0, side_j}, std::array{side_i, side_j}}) {
        const int ni = i + di, nj = j + dj;
        if (ni < 0 || nj < 0 || ni >= l.columns || nj >= l.rows) continue;
        const Place& there = best[std::size_t(nj) * l.columns + ni];
        if (squared(there, i, j) < squared(here, i, j)) here = there;
      }
    }
  return best;
}

class Tethers final : public RowStage {
 public:
  Tethers(const LatticeParts& parts, bool compliant, std::vector<std::vector<Place>> slots,
          std::int64_t count)
      : RowStage("tethers", "to at most " + std::to_string(slots.size()) + " pins each", 0, count,
                 "tethers"),
        parts_(parts),
        compliant_(compliant) {
    const Lattice& l = parts.lattice;
    moving_.resize(std::size_t(l.columns) * l.rows);
    for (const Pin& pin : parts.cloth.pins)
      if (pin.moves()) moving_[std::size_t(pin.j) * l.columns + pin.i] = &pin;
    for (auto& places : slots) {
      Slot& slot = slots_.emplace_back();
      slot.reach = AlignedArray<float>(std::size_t(l.rows) * l.stride);
      std::fill_n(slot.reach.data(), slot.reach.size(), kFree);
      slot.moves.assign(std::size_t(l.rows), false);
      for (int j = 0; j < l.rows; ++j)
        for (int i = 0; i < l.columns; ++i) {
          const Place p = places[std::size_t(j) * l.columns + i];
          if (p.i < 0) continue;
          slot.reach[std::size_t(j) * l.stride + i] =
              float(std::sqrt(squared_distance(parts.cloth.grid, p, i, j)));
          if (moving_[std::size_t(p.j) * l.columns + p.i]) slot.moves[j] = true;
        }
      slot.places = std::move(places);
      share_rows(slot);
    }
    Tethers::restart();
  }

  // Pins without a path stay where they are set.
  void restart() override {
    const Lattice& l = parts_.lattice;
    for (Slot& slot : slots_)
      for (int j = 0; j < l.rows; ++j)
        for (int i = 0; i < l.columns; ++i) {
          const Place p = slot.places[std::size_t(j) * l.columns + i];
          for (int k = 0; p.i >= 0 && k < 3; ++k)
            slot.pin.at(k, slot.row[std::size_t(j)], i) = l.x.at(k, p.j, p.i);
        }
  }

  std::size_t bytes() const override {
    std::size_t sum = 0;
    for (const Slot& s : slots_)
      sum += s.pin.bytes() + s.reach.size() * sizeof(float) + s.places.size() * sizeof(Place);
    return sum;
  }

  Velocities velocities(double dt) const override {
    return velocity_gain(parts_.scene.solver, compliant_, dt) == 0 ? Velocities::left_alone
                                                                   : Velocities::used;
  }
  void run(int begin, int end, const Substep& s) override {
    // The way over a torn sheet is another.
    if (parts_.tearing && parts_.tearing->torn() > 0) return;
    TetherRow r{};
    r.columns = parts_.lattice.columns;
    r.inverse_dt = velocity_gain(parts_.scene.solver, compliant_, s.dt);
    r.count = int(slots_.size());
    for (int j = begin; j < end; ++j) {
      r.x = parts_.lattice.x.row(j);
      r.v = parts_.lattice.v.row(j);
      for (int t = 0; t < r.count; ++t) {
        Slot& slot = slots_[std::size_t(t)];
        if (slot.moves[std::size_t(j)]) follow_pins(slot, j, s.time);
        r.tethers[t] = {slot.pin.row(slot.row[std::size_t(j)]),
                        slot.reach.data() + std::size_t(j) * parts_.lattice.stride};
      }
      parts_.kernels.tethers(r);
    }
  }

 private:
  struct Slot {
    std::vector<Place> places;
    Rows pin;
    std::vector<int> row;  // of `pin`, of every row of the lattice
    AlignedArray<float> reach;
    std::vector<bool> moves;  // rows with a tether to a pin on a path
  };

  // Rows whose tethers go to the same pins share a row of these, which so stay in the nearest cache;
  // unless the pins move: rows are in different substeps.
  void share_rows(Slot& slot) const {
    const auto columns = parts_.lattice.columns;
    const auto row = [&](int j) { return slot.places.begin() + std::ptrdiff_t(j) * columns; };
    int rows = 0;
    for (int j = 0; j < parts_.lattice.rows; ++j) {
      const bool shared = j > 0 && !slot.moves[std::size_t(j)] && !slot.moves[std::size_t(j) - 1] &&
                          std::equal(row(j), row(j) + columns, row(j - 1));
      if (!shared) ++rows;
      slot.row.push_back(rows - 1);
    }
    slot.pin = Rows(rows, parts_.lattice.stride);
  }

  // From the paths, not from the lattice, whose other rows are in other substeps.
  void follow_pins(Slot& slot, int j, double time) {
    const Lattice& l = parts_.lattice;
    for (int i = 0; i < l.columns; ++i) {
      const Place p = slot.places[std::size_t(j) * l.columns + i];
      const Pin* pin = p.i < 0 ? nullptr : moving_[std::size_t(p.j) * l.columns + p.i];
      if (!pin) continue;
      const Vec3 x = parts_.model.pin_position(*pin, time);
      for (int k = 0; k < 3; ++k) slot.pin.at(k, slot.row[std::size_t(j)], i) = float(x[k]);
    }
  }

  LatticeParts parts_;
  bool compliant_;  // velocities gain the corrections as computed
  std::vector<Slot> slots_;
  std::vector<const Pin*> moving_;  // of every particle, null where it has no path
};

}  // namespace

std::unique_ptr<RowStage> make_attachments(const LatticeParts& parts, bool compliant) {
  const Lattice& l = parts.lattice;
  if (parts.cloth.pins.empty()) return nullptr;
  // Slot s of a particle holds its s-th tether, so that few pins fill few slots.
  std::vector<std::vector<Place>> slots;
  std::array<std::vector<Place>, kTethers> found{nearest(parts, -1, -1), nearest(parts, 1, -1),
                                                 nearest(parts, -1, 1), nearest(parts, 1, 1)};
  std::int64_t count = 0;
  for (std::size_t p = 0; p < found[0].size(); ++p) {
    const int i = int(p) % l.columns, j = int(p) / l.columns;
    if (l.w(j, i) == 0) continue;
    std::size_t used = 0;
    for (int q = 0; q < kTethers; ++q) {
      const Place place = found[q][p];
      bool again = place.i < 0;
      for (std::size_t s = 0; s < used; ++s)
        again |= slots[s][p].i == place.i && slots[s][p].j == place.j;
      if (again) continue;
      if (used == slots.size()) slots.emplace_back(found[0].size());
      slots[used++][p] = place;
      ++count;
    }
  }
  if (count == 0) return nullptr;
  return std::make_unique<Tethers>(parts, compliant, std::move(slots), count);
}

}  // namespace weft::physics
