// Stage "keyed_pins" (keyed_pins.h).
#include "physics/model/keyed_pins.h"

namespace weft::physics {

namespace {

// Most pins that move have keys alone, and are many.
inline Vec3 place_of(const ClothParts& parts, const Pin& pin, double time) {
  const bool keys_alone = pin.follow < 0 && pin.rotate.keys.empty();
  return keys_alone ? position_at(pin.keys, time) : parts.model.pin_position(pin, time);
}

// A pin and its lane in the row.
struct PinAt {
  int i;
  const Pin* pin;
};

class KeyedPins final : public RowStage {
 public:
  KeyedPins(const ClothParts& parts, std::vector<std::vector<PinAt>> by_row, std::int64_t pins)
      : RowStage("keyed_pins", "pins put on their paths", 0, pins, "pins"),
        parts_(parts),
        by_row_(std::move(by_row)) {}
  void run(int j, const Substep& s) override {
    Particles& p = parts_.particles;
    for (const auto& [i, pin] : by_row_[std::size_t(j)]) {
      if (p.w(j, i) > 0) continue;  // let go since
      const Vec3 x = place_of(parts_, *pin, s.time);
      const Vec3 before = place_of(parts_, *pin, s.time - s.dt);
      for (int k = 0; k < 3; ++k) {
        p.x.at(k, j, i) = coordinate(x[k]);
        p.v.at(k, j, i) = float((x[k] - before[k]) / s.dt);
      }
    }
  }

 private:
  ClothParts parts_;
  std::vector<std::vector<PinAt>> by_row_;
};

}  // namespace

std::unique_ptr<RowStage> make_keyed_pins(const ClothParts& parts) {
  std::vector<std::vector<PinAt>> by_row(std::size_t(parts.particles.rows));
  std::int64_t pins = 0;
  for (const Pin& pin : parts.cloth.pins) {
    if (!pin.moves()) continue;
    const auto [j, i] = parts.particles.place(particle_number(parts.cloth, pin));
    by_row[std::size_t(j)].push_back({i, &pin});
    ++pins;
  }
  if (pins == 0) return nullptr;
  return std::make_unique<KeyedPins>(parts, std::move(by_row), pins);
}

}  // namespace weft::physics
