// Stage "keyed_pins": held particles that move along keys, turn or follow a collider are put where they are.
#include "physics/model/lattice/stages.h"
#include "physics/model/path.h"
#include "weft/shape.h"

namespace weft::physics {

namespace {

// Most pins that move have keys alone, and are many.
inline Vec3 place_of(const LatticeParts& parts, const Pin& pin, double time) {
  const bool keys_alone = pin.follow < 0 && pin.rotate.keys.empty();
  return keys_alone ? position_at(pin.keys, time) : pin_at(parts, pin, time);
}

class KeyedPins final : public RowStage {
 public:
  KeyedPins(const LatticeParts& parts, std::vector<std::vector<const Pin*>> by_row,
            std::int64_t pins)
      : RowStage("keyed_pins", "pins put on their paths", 0, pins, "pins"),
        parts_(parts),
        by_row_(std::move(by_row)) {}
  void run(int j, const Substep& s) override {
    Lattice& l = parts_.lattice;
    for (const Pin* pin : by_row_[j]) {
      if (l.w(j, pin->i) > 0) continue;  // let go since
      const Vec3 x = place_of(parts_, *pin, s.time);
      const Vec3 before = place_of(parts_, *pin, s.time - s.dt);
      for (int k = 0; k < 3; ++k) {
        l.x.at(k, j, pin->i) = coordinate(x[k]);
        l.v.at(k, j, pin->i) = float((x[k] - before[k]) / s.dt);
      }
    }
  }

 private:
  LatticeParts parts_;
  std::vector<std::vector<const Pin*>> by_row_;
};

}  // namespace

Vec3 pin_at(const LatticeParts& parts, const Pin& pin, double time) {
  const Vec3 alone = pin_alone_at(parts.cloth, pin, time);
  if (pin.follow < 0) return alone;
  const Collider& c = parts.scene.colliders[std::size_t(pin.follow)];
  return plus(alone, minus(displacement(c, time), parts.first_moves[std::size_t(pin.follow)]));
}

std::unique_ptr<RowStage> make_keyed_pins(const LatticeParts& parts) {
  std::vector<std::vector<const Pin*>> by_row(parts.lattice.rows);
  std::int64_t pins = 0;
  for (const Pin& pin : parts.cloth.pins) {
    if (!pin.moves()) continue;
    by_row[pin.j].push_back(&pin);
    ++pins;
  }
  if (pins == 0) return nullptr;
  return std::make_unique<KeyedPins>(parts, std::move(by_row), pins);
}

}  // namespace weft::physics
