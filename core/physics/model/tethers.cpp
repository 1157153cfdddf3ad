#include "physics/model/tethers.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "physics/kernels/second_order.h"
#include "physics/step/keeper.h"

namespace weft::physics {
namespace {

constexpr float kFree = 1e18f;  // m; the reach of a particle without a tether

// How much longer than it is rounding may make a distance from a pin. In thousands of substeps sweeps wander by some
// microns; tethers that are just taut would take that back inward alone, and draw in what is at rest.
double rounding(const Vec3& pin, double reach) {
  constexpr double kWanders =
      1.0 / (1 << 16);  // of a coordinate; with a quarter 1600 substeps a frame still wander on
  double farthest = 0;
  for (const double x : pin) farthest = std::max(farthest, std::abs(x));
  return kWanders * (farthest + reach);
}

class Tethers final : public RowStage {
 public:
  Tethers(const ClothParts& parts, const std::vector<std::vector<Tether>>& slots,
          std::int64_t count, Rows& corrections)
      : RowStage("tethers", "to at most " + std::to_string(slots.size()) + " pins each", 0, count,
                 "tethers"),
        parts_(parts),
        corrections_(corrections),
        moving_(std::size_t(parts.particles.count())) {
    for (const Pin& pin : parts.cloth.pins)
      if (pin.moves()) moving_[std::size_t(particle_number(parts.cloth, pin))] = &pin;
    for (const std::vector<Tether>& tethers : slots) add_slot(tethers);
    Tethers::restart();
  }

  // Pins without a path stay where they are set.
  void restart() override {
    const Particles& p = parts_.particles;
    for (Slot& slot : slots_)
      for_each_tether(slot, [&](int j, int i, int pin) {
        const auto at = p.place(pin);
        for (int k = 0; k < 3; ++k)
          slot.pin.at(k, slot.row[std::size_t(j)], i) = p.x.at(k, at.j, at.i);
      });
  }

  // Where a hand has carried them since does not count.
  void keep(Keeper& keeper) override {
    std::map<int, std::array<float, 3>> pins;
    const auto for_each = [&](const auto& visit) {
      for (Slot& slot : slots_)
        for_each_tether(slot, [&](int j, int i, int pin) {
          for (int k = 0; k < 3; ++k)
            visit(pins[pin][std::size_t(k)], slot.pin.at(k, slot.row[std::size_t(j)], i));
        });
    };
    for_each([](float& one, float all) { one = all; });
    for (auto& [pin, at] : pins) keeper(at);
    for_each([](float one, float& all) { all = one; });
  }

  std::size_t bytes() const override {
    std::size_t sum = 0;
    for (const Slot& s : slots_)
      sum += s.pin.bytes() + s.reach.size() * sizeof(float) + s.pins.size() * sizeof(int);
    return sum;
  }

  Velocities velocities() const override { return Velocities::left_alone; }
  void run(int begin, int end, const Substep& s) override {
    // The way over a torn sheet is another.
    if (const Tearing* tearing = parts_.model.tearing(); tearing && tearing->torn() > 0) return;
    Particles& p = parts_.particles;
    TetherRow r{};
    r.count = int(slots_.size());
    for (int j = begin; j < end; ++j) {
      r.columns = p.count(j);
      r.x = p.x.row(j);
      r.u = corrections_.row(j);
      for (int t = 0; t < r.count; ++t) {
        Slot& slot = slots_[std::size_t(t)];
        if (slot.moves[std::size_t(j)]) follow_pins(slot, j, s.time);
        r.tethers[t] = {slot.pin.row(slot.row[std::size_t(j)]),
                        slot.reach.data() + std::size_t(j) * std::size_t(p.stride)};
      }
      parts_.kernels.particles.tethers(r);
    }
  }

 private:
  struct Slot {
    std::vector<int> pins;  // of the particles, row after row; -1: none
    Rows pin;
    std::vector<int> row;  // of `pin`, of every row of particles
    AlignedArray<float> reach;
    std::vector<bool> moves;  // rows with a tether to a pin on a path
  };

  int pin_of(const Slot& slot, int j, int i) const {
    return slot.pins[std::size_t(parts_.particles.first[std::size_t(j)] + i)];
  }
  template <class Visit>
  void for_each_tether(const Slot& slot, const Visit& visit) const {
    for (int j = 0; j < parts_.particles.rows; ++j)
      for (int i = 0; i < parts_.particles.count(j); ++i)
        if (const int pin = pin_of(slot, j, i); pin >= 0) visit(j, i, pin);
  }

  void add_slot(const std::vector<Tether>& tethers) {
    const Particles& p = parts_.particles;
    Slot& slot = slots_.emplace_back();
    slot.reach = AlignedArray<float>(std::size_t(p.rows) * std::size_t(p.stride));
    std::fill_n(slot.reach.data(), slot.reach.size(), kFree);
    slot.moves.assign(std::size_t(p.rows), false);
    for (int j = 0; j < p.rows; ++j)
      for (int i = 0; i < p.count(j); ++i)
        slot.pins.push_back(tethers[std::size_t(p.number(j, i))].pin);
    for_each_tether(slot, [&](int j, int i, int pin) {
      const auto [pin_row, pin_lane] = p.place(pin);
      const double reach = tethers[std::size_t(p.number(j, i))].reach;
      slot.reach[std::size_t(j) * std::size_t(p.stride) + std::size_t(i)] =
          float(reach + rounding(p.position(pin_row, pin_lane), reach));
      if (moving_[std::size_t(pin)]) slot.moves[std::size_t(j)] = true;
    });
    share_rows(slot);
  }

  // Rows whose tethers go to the same pins share a row of these, which so stay in the nearest cache;
  // unless the pins move: rows are in different substeps.
  void share_rows(Slot& slot) const {
    const Particles& p = parts_.particles;
    const auto pins = [&](int j) { return slot.pins.begin() + p.first[std::size_t(j)]; };
    int rows = 0;
    for (int j = 0; j < p.rows; ++j) {
      const bool shared = j > 0 && !slot.moves[std::size_t(j)] && !slot.moves[std::size_t(j) - 1] &&
                          std::equal(pins(j), pins(j + 1), pins(j - 1), pins(j));
      if (!shared) ++rows;
      slot.row.push_back(rows - 1);
    }
    slot.pin = Rows(rows, p.stride);
  }

  // From the paths, not from the particles, whose other rows are in other substeps.
  void follow_pins(Slot& slot, int j, double time) {
    const Pin* last = nullptr;  // neighbours mostly have the same
    Vec3 x{};
    for (int i = 0; i < parts_.particles.count(j); ++i) {
      const int number = pin_of(slot, j, i);
      const Pin* pin = number < 0 ? nullptr : moving_[std::size_t(number)];
      if (!pin) continue;
      if (pin != last) x = parts_.model.pin_position(*pin, time);
      last = pin;
      for (std::size_t k = 0; k < 3; ++k)
        slot.pin.at(int(k), slot.row[std::size_t(j)], i) = float(x[k]);
    }
  }

  ClothParts parts_;
  Rows& corrections_;
  std::vector<const Pin*> moving_;  // of every particle, null where it has no path
  std::vector<Slot> slots_;
};

}  // namespace

void add_tether(std::vector<std::vector<Tether>>& slots, int particles, int particle,
                const Tether& tether) {
  std::size_t s = 0;
  while (s < slots.size() && slots[s][std::size_t(particle)].pin >= 0) ++s;
  if (s == slots.size()) slots.emplace_back(std::size_t(particles));
  slots[s][std::size_t(particle)] = tether;
}

std::unique_ptr<RowStage> make_tethers(const ClothParts& parts,
                                       const std::vector<std::vector<Tether>>& slots,
                                       Rows& corrections) {
  std::int64_t count = 0;
  for (const std::vector<Tether>& slot : slots)
    count += std::count_if(slot.begin(), slot.end(), [](const Tether& t) { return t.pin >= 0; });
  if (count == 0) return nullptr;
  return std::make_unique<Tethers>(parts, slots, count, corrections);
}

}  // namespace weft::physics
