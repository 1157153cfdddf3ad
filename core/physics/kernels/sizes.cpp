// The size of many values at once, by which the end of a frame tells whether all is well.
#include "physics/kernels/row_kernels.h"

namespace weft::WEFT_KERNELS {

namespace {
constexpr int kBlocks = 16 / kLanes;  // of 16 values: in the same lanes at every width

typedef double WideDouble __attribute__((vector_size(8 * kLanes)));
WEFT_INLINE WideDouble twice(Wide v) {  // as precise
  return __builtin_convertvector(v, WideDouble);
}

// As whole numbers the sizes of floats have the order of their bits, and what is not a number lies
// above infinity.
class Greatest {
 public:
  void add(int block, Wide values) {
    const WideInt size = (WideInt)values & 0x7fffffff;
    most_[block] = select(size > most_[block], size, most_[block]);
  }
  float value() const {
    constexpr int kInfinite = 0x7f800000;
    int greatest = 0;
    for (const WideInt& m : most_)
      for (int lane = 0; lane < kLanes; ++lane) greatest = m[lane] > greatest ? m[lane] : greatest;
    return ((Wide)(WideInt{} + (greatest > kInfinite ? kInfinite : greatest)))[0];
  }

 private:
  WideInt most_[kBlocks] = {};
};
}  // namespace

float greatest(const float* values, std::ptrdiff_t count) {
  Greatest most;
  for (std::ptrdiff_t i = 0; i < count; i += 16)
    for (int b = 0; b < kBlocks; ++b) most.add(b, load(values + i + b * kLanes));
  return most.value();
}

// In double: what a small swing releases is a millionth of the height it has. Gravity mostly points along
// an axis.
physics::EnergySum energy_sum(const physics::EnergyRow& r) {
  const double g[] = {r.g[0], r.g[1], r.g[2]};
  WideDouble motion[kBlocks] = {}, height[kBlocks] = {};
  Greatest most;
  for (int i = 0; i < padded(r.columns); i += 16)
    for (int b = 0; b < kBlocks; ++b) {
      const int at = i + b * kLanes;
      const Wide w = load(r.w + at);
      const WideDouble mass = twice(select(w > 0.0f, 1.0f / w, Wide{}));
      const Wide3 v = load3(r.v, at), x = load3(r.x, at);
      motion[b] = motion[b] + mass * twice(dot(v, v));
      const Wide along[] = {x.x, x.y, x.z};
      for (int k = 0; k < 3; ++k) {
        if (g[k] != 0) height[b] = height[b] - mass * (twice(along[k]) * g[k]);
        most.add(b, along[k]);
      }
    }
  physics::EnergySum e{0, 0, most.value()};
  for (int b = 0; b < kBlocks; ++b)
    for (int lane = 0; lane < kLanes; ++lane) {
      e.kinetic += 0.5 * motion[b][lane];
      e.potential += height[b][lane];
    }
  return e;
}

float greatest_square(const physics::FarRows& r) {
  Wide most{};
  for (int a = 0; a < r.count; a += kLanes) {
    const Wide3 e = load3(r.far, a) - load3(r.near, a);
    const Wide squared = dot(e, e);
    WideInt there = lanes_below(r.count - a);
    if (r.alive) there = there & lanes_at(r.alive + a);
    most = select(there & (squared > most), squared, most);
  }
  return greatest(most);
}

double stretch_energy(const physics::StretchRow& r) {
  WideDouble sum[kBlocks] = {};
  for (int i = 0; i < padded(r.count); i += 16)
    for (int b = 0; b < kBlocks; ++b) {
      const int a = i + b * kLanes;
      const Wide w = load(r.w_near + a) + load(r.w_far + a);
      WideInt there = lanes_below(r.count - a) & (w > 0.0f);
      if (r.alive) there = there & lanes_at(r.alive + a);
      const Wide3 e = load3(r.far, a) - load3(r.near, a);
      const Wide off = abs(sqrt(dot(e, e)) - r.rest) + r.slack;
      const Wide rigid = r.inverse_dt2 / w;
      const Wide stiffness = r.factor ? load(r.factor + a) * r.stiffness : wide(r.stiffness);
      const Wide k = select(there, min(rigid * r.share, stiffness), Wide{});
      const Wide over = max(off - r.give, Wide{});
      sum[b] = sum[b] + twice(k) * twice(off) * twice(off) +
               twice(select(there, rigid, Wide{})) * twice(over) * twice(over);
    }
  double energy = 0;
  for (const WideDouble& s : sum)
    for (int lane = 0; lane < kLanes; ++lane) energy += 0.5 * s[lane];
  return energy;
}

}  // namespace weft::WEFT_KERNELS
