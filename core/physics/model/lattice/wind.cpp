// Stage "wind": air on the triangles of one cloth. Gusts are waves in space whose phases move with
// the wind and turn in time, chosen by the seed: the same for any order of work.
//
// Air changes far more slowly than springs do: within a frame it pushes once for up to a millisecond
// of substeps, with the impulse of all of them (multiple time steps: Tuckerman, Berne, Martyna 1992).
#include <cmath>

#include "physics/model/lattice/stages.h"
#include "physics/model/path.h"
#include "physics/model/random.h"

namespace weft::physics {
namespace {

constexpr double kShortest = 0.4, kLongest = 2.5;  // m, of a gust
constexpr double kPush = 1e-3;                     // s, from one push to the next at most
constexpr double kSlowest = 0.3, kFastest = 2;     // turns a second, of a gust in still air
constexpr std::uint64_t kStream = 1u << 20;        // apart from the cloths' streams

struct Wave {
  Vec3 k;              // 1/m
  double rate, phase;  // turns a second, turns
};

class WindStage final : public RowStage {
 public:
  WindStage(const LatticeParts& parts, std::uint64_t seed)
      : RowStage("wind",
                 std::string("drag and lift of triangles") +
                     (parts.scene.wind.turbulence > 0 ? ", gusts" : "") +
                     (parts.scene.wind.velocity_keys.empty() ? "" : ", along keys"),
                 1, 2 * std::int64_t(parts.lattice.columns - 1) * (parts.lattice.rows - 1),
                 "triangles"),
        parts_(parts) {
    const Wind& wind = parts.scene.wind;
    Random random(seed, kStream);
    for (Wave& w : waves_) {
      Vec3 d{random.symmetric(), random.symmetric(), random.symmetric()};
      const double size = std::max(std::hypot(d[0], d[1], d[2]), 1e-3);
      const double length = kShortest * std::pow(kLongest / kShortest, random.unit());
      for (int k = 0; k < 3; ++k) w.k[k] = d[k] / size / length;
      const double carried = wind.velocity_keys.empty() ? dot(wind.velocity, w.k) : 0;
      w.rate = kSlowest + (kFastest - kSlowest) * random.unit() - carried;
      w.phase = random.unit();
    }
  }

  // What it reads, predict has brought up to date.
  Velocities velocities(double dt) const override {
    return push_of(parts_, dt).velocities ? Velocities::used : Velocities::left_alone;
  }
  void reserve_slots(int slots) override {
    force_ = Rows(2 * slots, parts_.lattice.stride);
    resistance_ = Rows(2 * slots, parts_.lattice.stride);
  }
  std::size_t bytes() const override { return force_.bytes() + resistance_.bytes(); }

  void start(const Substep& s) override {
    for (int k = 0; k < 2; ++k)
      for (Rows* rows : {&force_, &resistance_})
        zero(rows->row(2 * s.slot + k), parts_.lattice.stride);
  }

  void run(int j, const Substep& s) override {
    const int steps = substeps_pushed(s);
    if (steps == 0) return;
    Lattice& l = parts_.lattice;
    if (j + 1 < l.rows) parts_.kernels.wind(wind_row(j, s));
    const Push pushed = push_of(parts_, s.dt);
    parts_.kernels.push({l.columns, l.x.row(j), l.v.row(j), l.w(j), air(j, s),
                         float(steps * pushed.dt), float(pushed.dt), pushed.velocities});
  }

 private:
  // For how many substeps this one pushes; 0: another one does. It is the one whose end, where it
  // finds the sheet, is nearest to the middle of them all, or the one before.
  int substeps_pushed(const Substep& s) const {
    const double frame = parts_.scene.time.frame;
    const int all = int(std::lround(frame / s.dt));
    const int together = std::clamp(int(kPush / s.dt), 1, all);
    const double start = std::floor((s.time - 0.5 * s.dt) / frame) * frame;
    const int number = int(std::lround((s.time - start) / s.dt)) - 1;  // in the frame
    const int first = number / together * together, steps = std::min(together, all - first);
    return number == first + (steps - 1) / 2 ? steps : 0;
  }

  AirRow air(int row, const Substep& s) {
    const int k = 2 * s.slot + row % 2;
    const Row3 resistance = resistance_.row(k);
    return {force_.row(k), resistance.x, resistance.y};
  }

  WindRow wind_row(int j, const Substep& s) {
    Lattice& l = parts_.lattice;
    const Wind& wind = parts_.scene.wind;
    WindRow r{};
    r.columns = l.columns;
    r.x = l.x.row(j);
    r.x_next = l.x.row(j + 1);
    r.v = l.v.row(j);
    r.v_next = l.v.row(j + 1);
    r.air = air(j, s);
    r.air_next = air(j + 1, s);
    const Vec3 u = wind_at(wind, s.time);
    r.wx = float(u[0]);
    r.wy = float(u[1]);
    r.wz = float(u[2]);
    r.drag = float(wind.drag);
    r.lift = float(wind.lift);
    // Gusts go with the air; where its velocity does not change that is in their rate.
    const bool changes = !wind.velocity_keys.empty() && wind.turbulence > 0;
    const Vec3 way = changes ? integral_of(wind.velocity_keys, s.time) : Vec3{};
    r.gust_speed = float(wind.turbulence * std::hypot(u[0], u[1], u[2]));
    for (int n = 0; n < kGusts; ++n) {
      const Wave& w = waves_[n];
      const double phase = w.phase + w.rate * s.time - dot(way, w.k);
      r.gusts[n] = {float(w.k[0]), float(w.k[1]), float(w.k[2]), float(phase - std::floor(phase))};
    }
    return r;
  }

  LatticeParts parts_;
  std::array<Wave, kGusts> waves_;
  Rows force_, resistance_;  // two rows in turn per slot; of the resistance, drag and lift
};

}  // namespace

std::unique_ptr<RowStage> make_wind(const LatticeParts& parts, std::uint64_t seed) {
  const Wind& wind = parts.scene.wind;
  if (wind.drag == 0 && wind.lift == 0) return nullptr;
  return std::make_unique<WindStage>(parts, seed);
}

}  // namespace weft::physics
