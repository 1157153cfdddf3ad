#include "physics/model/wind_stage.h"

#include <algorithm>
#include <cmath>

#include "physics/model/path.h"
#include "physics/model/push.h"
#include "weft/random.h"

namespace weft::physics {
namespace {

constexpr double kShortest = 0.4, kLongest = 2.5;  // m, of a gust
constexpr double kPush = 1e-3;                     // s, from one push to the next at most
constexpr double kSlowest = 0.3, kFastest = 2;     // turns a second, of a gust in still air
constexpr std::uint64_t kStream = 1u << 20;        // apart from the cloths' streams

}  // namespace

WindStage::WindStage(const ClothParts& parts, std::uint64_t seed, std::int64_t triangles)
    : RowStage("wind",
               std::string("drag and lift of triangles") +
                   (parts.scene.wind.turbulence > 0 ? ", gusts" : "") +
                   (parts.scene.wind.velocity_keys.empty() ? "" : ", along keys"),
               1, triangles, "triangles"),
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

void WindStage::reserve_slots(int slots) {
  force_ = Rows(2 * slots, parts_.particles.stride);
  resistance_ = Rows(2 * slots, parts_.particles.stride);
}

void WindStage::start(const Substep& s) {
  for (int k = 0; k < 2; ++k)
    for (Rows* rows : {&force_, &resistance_})
      zero(rows->row(2 * s.slot + k), parts_.particles.stride);
}

void WindStage::run(int j, const Substep& s) {
  const int steps = substeps_pushed(s);
  if (steps == 0) return;
  Particles& p = parts_.particles;
  blow(j, s);
  // A push of the second order is two thirds of what it comes to in the substeps after it, of which its own knows so
  // much and the others all.
  const double time = push_time(parts_, s.dt), resists = (steps - 1) * s.dt + time;
  const bool at_end = parts_.scene.solver.order == 2 && !is_explicit(parts_.method) && steps == 1;
  parts_.kernels.particles.push({p.count(j), p.x.row(j), p.v.row(j), p.w(j), sums(j, s),
                                 float(steps * time), float(resists), float(time), at_end});
}

// For how many substeps this one pushes; 0: another one does. It is the one whose end, where it
// finds the cloth, is nearest to the middle of them all, or the one before.
int WindStage::substeps_pushed(const Substep& s) const {
  const double frame = parts_.scene.time.frame;
  const int all = int(std::lround(frame / s.dt));
  const int together = std::clamp(int(kPush / s.dt), 1, all);
  const double start = std::floor((s.time - 0.5 * s.dt) / frame) * frame;
  const int number = int(std::lround((s.time - start) / s.dt)) - 1;  // in the frame
  const int first = number / together * together, steps = std::min(together, all - first);
  return number == first + (steps - 1) / 2 ? steps : 0;
}

AirRow WindStage::sums(int row, const Substep& s) {
  const int k = 2 * s.slot + row % 2;
  const Row3 resistance = resistance_.row(k);
  return {force_.row(k), resistance.x, resistance.y};
}

void WindStage::set_air(Air& air, const Substep& s) const {
  const Wind& wind = parts_.scene.wind;
  const Vec3 u = wind_at(wind, s.time);
  air.wx = float(u[0]);
  air.wy = float(u[1]);
  air.wz = float(u[2]);
  air.drag = float(wind.drag);
  air.lift = float(wind.lift);
  // Gusts go with the air; where its velocity does not change that is in their rate.
  const bool changes = !wind.velocity_keys.empty() && wind.turbulence > 0;
  const Vec3 way = changes ? integral_of(wind.velocity_keys, s.time) : Vec3{};
  air.gust_speed = float(wind.turbulence * std::hypot(u[0], u[1], u[2]));
  for (int n = 0; n < kGusts; ++n) {
    const Wave& w = waves_[n];
    const double phase = w.phase + w.rate * s.time - dot(way, w.k);
    air.gusts[n] = {float(w.k[0]), float(w.k[1]), float(w.k[2]), float(phase - std::floor(phase))};
  }
}

}  // namespace weft::physics
