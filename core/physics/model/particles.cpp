// The state of one cloth's particles (particles.h).
#include "physics/model/particles.h"

#include <algorithm>
#include <utility>

#include "physics/step/keeper.h"
#include "weft/vec3.h"

namespace weft::physics {

Particles::Particles(const std::vector<int>& counts, bool keep_previous, std::vector<int> numbers)
    : rows(int(counts.size())),
      stride(row_stride(*std::max_element(counts.begin(), counts.end()))),
      first(counts.size() + 1),
      x(rows, stride),
      v(rows, stride),
      inverse_mass(static_cast<std::size_t>(rows) * stride),
      column_width(static_cast<std::size_t>(stride)),
      inverse_width(static_cast<std::size_t>(stride)),
      row_inverse_mass(static_cast<std::size_t>(rows)),
      numbers_(std::move(numbers)),
      slots_(numbers_.size()) {
  for (std::size_t n = 0; n < numbers_.size(); ++n) slots_[std::size_t(numbers_[n])] = int(n);
  for (std::size_t j = 0; j < counts.size(); ++j) first[j + 1] = first[j] + counts[j];
  if (keep_previous) previous = Rows(rows, stride);
  std::fill_n(column_width.data(), column_width.size(), 1.0f);
  std::fill_n(inverse_width.data(), inverse_width.size(), 1.0f);
}

Particles::Place Particles::place(int particle) const {
  assert(particle >= 0 && particle < count());
  return place_of_slot(slots_.empty() ? particle : slots_[std::size_t(particle)]);
}

Particles::Place Particles::place_of_slot(int slot) const {
  const auto next = std::upper_bound(first.begin(), first.end(), slot);
  const int j = int(next - first.begin()) - 1;
  return {j, slot - first[std::size_t(j)]};
}

std::vector<Vec3> Particles::gather(const Rows& values) const {
  std::vector<Vec3> all;
  all.reserve(std::size_t(count()));
  for_each([&](int j, int i) {
    all.push_back({values.at(0, j, i), values.at(1, j, i), values.at(2, j, i)});
  });
  return all;
}

void Particles::keep(Rows& values, Keeper& keeper) const {
  for (int j = 0; j < rows; ++j) {
    const Row3 row = values.row(j);
    for (float* const component : {row.x, row.y, row.z}) keeper.of(component, count(j));
  }
}

void Particles::set_inverse_mass(int j, int i, float value) {
  w(j)[i] = value;
  weigh_row(j);
}

void Particles::weigh_row(int j) {
  const float* const row = w(j);
  const float inner = row[0] * column_width[0];
  bool uniform = true;
  for (int i = 0; i < count(j); ++i)
    uniform &= row[i] == inner * inverse_width[static_cast<std::size_t>(i)];
  row_inverse_mass[static_cast<std::size_t>(j)] = uniform ? inner : 0.0f;
}

void set_in_motion(Particles& p, const Vec3& velocity, const Vec3& spin,
                   const std::vector<double>& masses) {
  if (velocity == Vec3{} && spin == Vec3{}) return;
  Vec3 middle{};
  double mass = 0;
  p.for_each([&](int j, int i) {
    const double m = masses[std::size_t(p.number(j, i))];
    middle = plus(middle, times(p.position(j, i), m));
    mass += m;
  });
  middle = times(middle, 1 / mass);
  p.for_each([&](int j, int i) {
    if (!(p.w(j, i) > 0)) return;
    const Vec3 v = plus(velocity, cross(spin, minus(p.position(j, i), middle)));
    for (int k = 0; k < 3; ++k) p.v.at(k, j, i) = float(v[std::size_t(k)]);
  });
}

EnergyRow energy_row(const Particles& particles, ConstRow3 x, ConstRow3 v, int j,
                     const Vec3& gravity) {
  return {particles.count(j), x, v, particles.w(j), {gravity[0], gravity[1], gravity[2]}};
}

}  // namespace weft::physics
