#include "physics/model/mesh/gas_load.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/model/number.h"
#include "physics/model/projected_motion.h"
#include "physics/step/threads.h"
#include "weft/vec3.h"

namespace weft::physics {
namespace {

constexpr int kPart = 1024;          // points or triangles that are added up together
constexpr int kFewTriangles = 4096;  // one thread is faster

std::string words_of(const Pressure& pressure, const Gas& gas) {
  std::string words = pressure.inflate > 0 ? number(pressure.inflate) + " times the gas of " +
                                                 number(gas.volume_at_start()) + " m³ at " +
                                                 number(pressure.ambient) + " Pa"
                                           : number(pressure.over) + " Pa on the inside";
  if (!pressure.keys.empty()) words += ", along keys";
  return words;
}

class PressureStage final : public WholeStage {
 public:
  PressureStage(const ClothParts& parts, const Gas& gas, History* history)
      : WholeStage("pressure", words_of(parts.cloth.pressure, gas), gas.triangles(), "triangles"),
        parts_(parts),
        gas_(gas),
        history_(history),
        work_(gas.work()),
        volumes_(parts_in(gas.triangles())),
        growths_(parts_in(gas.points())) {}

  std::size_t bytes() const override {
    return (2 * work_.points.size() + work_.normals.size()) * sizeof(Vec3) +
           (volumes_.size() + growths_.size()) * sizeof(double);
  }

  // Sums of parts are added in their order, whichever threads they come from.
  void run(const Substep& s, Threads& threads) override {
    const auto share = [&](int count, const auto& visit) {
      threads.share(parts_in(count), gas_.triangles() < kFewTriangles, [&](std::size_t n) {
        visit(n, RowSpan{int(n) * kPart, std::min(int(n + 1) * kPart, count)});
      });
    };
    share(gas_.points(),
          [&](std::size_t, RowSpan span) { gas_.gather(parts_.particles.x, span, work_); });
    share(gas_.triangles(),
          [&](std::size_t n, RowSpan span) { volumes_[n] = gas_.measure(span, work_); });
    share(gas_.points(), [&](std::size_t n, RowSpan span) {
      gas_.derive(span, work_);
      growths_[n] = mobility(span);
    });
    const double volume = sum_of(volumes_) / 6;
    const double p = is_explicit(parts_.method) ? over_at_start(s, volume) : over_at_end(s, volume);
    share(gas_.points(), [&](std::size_t, RowSpan span) { push(span, p, s); });
  }

 private:
  static std::size_t parts_in(int count) { return std::size_t((count + kPart - 1) / kPart); }
  static double sum_of(const std::vector<double>& parts) {
    double sum = 0;
    for (const double part : parts) sum += part;
    return sum;
  }

  // grad V · M⁻¹ grad V, of some points.
  double mobility(RowSpan span) const {
    double sum = 0;
    for (int p = span.begin; p < span.end; ++p) {
      double w = 0;
      for (const auto& [place, number] : gas_.members(p))
        w += double(parts_.particles.w(place.j, place.i));
      const Vec3& gradient = work_.gradients[std::size_t(p)];
      sum += w * dot(gradient, gradient);
    }
    return sum;
  }

  double over_at_start(const Substep& s, double volume) const {
    return gas_.law().over(gas_.law().share(s.time - s.dt), volume);
  }
  double over_at_end(const Substep& s, double volume) const {
    const double dt = push_time(parts_, s.dt);
    return gas_.law().over_after(gas_.law().share(s.time), volume, dt * dt * sum_of(growths_));
  }

  void push(RowSpan span, double over, const Substep& s) {
    Particles& particles = parts_.particles;
    const bool forces = is_explicit(parts_.method);
    const double time = push_time(parts_, s.dt), kick = forces ? s.kick : time;
    const bool keeps = history_ && history_->left.kept;
    for (int p = span.begin; p < span.end; ++p)
      for (const auto& [place, number] : gas_.members(p)) {
        const auto [j, i] = place;
        const double gain = over * kick * double(particles.w(j, i));
        if (gain == 0) continue;
        for (int k = 0; k < 3; ++k) {
          const double gained = gain * work_.gradients[std::size_t(p)][std::size_t(k)];
          float &x = particles.x.at(k, j, i), &v = particles.v.at(k, j, i);
          if (keeps) {
            move_keeping(v, history_->left.v.at(k, j, i), gained);
            move_keeping(x, history_->left.x.at(k, j, i), gained * time);
            continue;
          }
          v = float(double(v) + gained);
          if (!forces) x = float(double(x) + gained * time);
        }
      }
  }

  ClothParts parts_;
  const Gas& gas_;
  History* history_;  // or null
  Gas::Work work_;
  std::vector<double> volumes_, growths_;  // of parts
};

}  // namespace

GasLoad::GasLoad(const ClothParts& parts, const Seams& seams)
    : parts_(parts), seams_(seams), gas_(parts.cloth, parts.particles), work_(gas_.work()) {}

void GasLoad::add_accelerations(double time, std::vector<Vec3>& a) const {
  const double volume = gas_.look(parts_.particles.x, work_);
  const double over = gas_.law().over(gas_.law().share(time), volume);
  std::vector<Vec3> gained(a.size());
  for (int p = 0; p < gas_.points(); ++p)
    for (const auto& [place, number] : gas_.members(p))
      gained[std::size_t(number)] = times(work_.gradients[std::size_t(p)],
                                          over * double(parts_.particles.w(place.j, place.i)));
  seams_.share(parts_.particles, gained);
  for (std::size_t n = 0; n < a.size(); ++n) a[n] = plus(a[n], gained[n]);
}

double GasLoad::energy(double time) const {
  return gas_.law().energy(gas_.law().share(time), gas_.look(parts_.particles.x, work_));
}

double GasLoad::greatest_energy(const std::vector<Vec3>& x) const {
  return gas_.law().energy(gas_.law().greatest_share(), gas_.look(x, work_));
}

// A constant pressure: up to the volume of the ball of two and a quarter times the area, or down to none.
double GasLoad::reserve() const {
  if (gas_.law().ideal()) return 0;
  const double volume = gas_.look(parts_.particles.x, work_);
  const double area = 1.5 * 1.5 * gas_.area(work_);
  const double most = std::pow(area, 1.5) / (6 * std::sqrt(std::numbers::pi));
  const double over = gas_.law().over(gas_.law().greatest_share(), volume);
  return over > 0 ? over * std::max(0.0, most - volume) : -over * std::max(0.0, volume);
}

// The gas by itself is one mode; and forces turn with the surface.
double GasLoad::omega_squared() const {
  const double volume = gas_.look(parts_.particles.x, work_);
  const double share = gas_.law().greatest_share();
  double mobility = 0, turning = 0;
  for (int p = 0; p < gas_.points(); ++p) {
    const double bend = gas_.turning(work_, p);
    const Vec3& gradient = work_.gradients[std::size_t(p)];
    for (const auto& [place, number] : gas_.members(p)) {
      const double w = double(parts_.particles.w(place.j, place.i));
      mobility += w * dot(gradient, gradient);
      turning = std::max(turning, w * bend);
    }
  }
  return gas_.law().stiffness(share, volume) * mobility +
         std::abs(gas_.law().over(share, volume)) * turning;
}

std::unique_ptr<Stage> make_pressure(const ClothParts& parts, const Gas& gas, History* history) {
  return std::make_unique<PressureStage>(parts, gas, history);
}

}  // namespace weft::physics
