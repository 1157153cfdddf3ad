// Stage "wind": air on the triangles of one cloth. Gusts are waves in space whose phases move with
// the wind and turn in time, chosen by the seed: the same for any order of work.
//
// Air changes far more slowly than springs do: within a frame it pushes once for up to a millisecond
// of substeps, with the impulse of all of them (multiple time steps: Tuckerman, Berne, Martyna 1992).
#include <cmath>

#include "physics/random.h"
#include "physics/stages/stages.h"

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
  WindStage(const ClothParts& parts, std::uint64_t seed)
      : RowStage("wind",
                 parts.scene.wind.turbulence > 0 ? "drag and lift of triangles, gusts"
                                                 : "drag and lift of triangles",
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
      const double carried =
          wind.velocity[0] * w.k[0] + wind.velocity[1] * w.k[1] + wind.velocity[2] * w.k[2];
      w.rate = kSlowest + (kFastest - kSlowest) * random.unit() - carried;
      w.phase = random.unit();
    }
  }

  // What it reads, predict has brought up to date.
  Velocities velocities(double dt) const override {
    return push_of(parts_, dt).velocities ? Velocities::used : Velocities::left_alone;
  }
  void reserve_slots(int slots) override { force_ = Rows(2 * slots, parts_.lattice.stride); }
  std::size_t bytes() const override { return force_.bytes(); }

  void start(const Substep& s) override {
    for (int k = 0; k < 2; ++k) zero(force_.row(2 * s.slot + k), parts_.lattice.stride);
  }

  void run(int j, const Substep& s) override {
    const int steps = substeps_pushed(s);
    if (steps == 0) return;
    Lattice& l = parts_.lattice;
    const auto force = [&](int row) { return force_.row(2 * s.slot + row % 2); };
    if (j + 1 < l.rows) parts_.kernels.wind(wind_row(j, s, steps, force(j), force(j + 1)));
    AdvanceRow a{};
    a.columns = l.columns;
    a.x = l.x.row(j);
    a.v = l.v.row(j);
    a.w = l.w(j);
    a.f = force(j);
    const Push pushed = push_of(parts_, s.dt);
    a.advance.dt = float(pushed.dt);
    a.inverse_dt = pushed.velocities ? float(1 / pushed.dt) : 0;
    parts_.kernels.push(a);
  }

 private:
  // For how many substeps this one pushes; 0: one before it has done so.
  int substeps_pushed(const Substep& s) const {
    const double frame = parts_.scene.time.frame;
    const int all = int(std::lround(frame / s.dt));
    const int together = std::clamp(int(kPush / s.dt), 1, all);
    const double start = std::floor((s.time - 0.5 * s.dt) / frame) * frame;
    const int number = int(std::lround((s.time - start) / s.dt)) - 1;  // in the frame
    return number % together == 0 ? std::min(together, all - number) : 0;
  }

  WindRow wind_row(int j, const Substep& s, int steps, Row3 f, Row3 f_next) {
    Lattice& l = parts_.lattice;
    const Wind& wind = parts_.scene.wind;
    WindRow r{};
    r.columns = l.columns;
    r.x = l.x.row(j);
    r.x_next = l.x.row(j + 1);
    r.v = l.v.row(j);
    r.v_next = l.v.row(j + 1);
    r.w = l.w(j);
    r.w_next = l.w(j + 1);
    r.f = f;
    r.f_next = f_next;
    r.dt = float(steps * s.dt);
    r.steps = float(steps);
    r.wx = float(wind.velocity[0]);
    r.wy = float(wind.velocity[1]);
    r.wz = float(wind.velocity[2]);
    r.drag = float(wind.drag);
    r.lift = float(wind.lift);
    const Vec3& u = wind.velocity;
    r.gust_speed = float(wind.turbulence * std::hypot(u[0], u[1], u[2]));
    for (int n = 0; n < kGusts; ++n) {
      const Wave& w = waves_[n];
      const double phase = w.phase + w.rate * s.time;
      r.gusts[n] = {float(w.k[0]), float(w.k[1]), float(w.k[2]), float(phase - std::floor(phase))};
    }
    return r;
  }

  ClothParts parts_;
  std::array<Wave, kGusts> waves_;
  Rows force_;  // two rows in turn per slot
};

}  // namespace

std::unique_ptr<RowStage> make_wind(const ClothParts& parts, std::uint64_t seed) {
  const Wind& wind = parts.scene.wind;
  if (wind.drag == 0 && wind.lift == 0) return nullptr;
  return std::make_unique<WindStage>(parts, seed);
}

}  // namespace weft::physics
