#include "physics/model/mesh/gas.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "weft/mesh.h"
#include "weft/vec3.h"

namespace weft::physics {
namespace {

// The part that each triangle belongs to: parts share no point.
std::vector<int> parts_of(const EnclosingSurface& surface) {
  std::vector<int> part(surface.members.size());
  std::iota(part.begin(), part.end(), 0);
  const auto root = [&](int p) {
    while (part[std::size_t(p)] != p)
      p = part[std::size_t(p)] = part[std::size_t(part[std::size_t(p)])];
    return p;
  };
  for (const auto& [a, b, c] : surface.triangles)
    for (const int other : {b, c}) {
      const int one = root(a), two = root(other);
      part[std::size_t(std::max(one, two))] = std::min(one, two);
    }
  std::vector<int> parts;
  for (const auto& t : surface.triangles) parts.push_back(root(t[0]));
  return parts;
}

}  // namespace

double GasLaw::share(double time) const {
  const std::vector<Share>& keys = pressure_.keys;
  if (keys.empty()) return 1;
  if (time <= keys.front().time) return keys.front().value;
  for (std::size_t n = 1; n < keys.size(); ++n) {
    if (time >= keys[n].time) continue;
    const Share &a = keys[n - 1], &b = keys[n];
    return a.value + (time - a.time) / (b.time - a.time) * (b.value - a.value);
  }
  return keys.back().value;
}

double GasLaw::greatest_share() const {
  double most = pressure_.keys.empty() ? 1 : 0;
  for (const Share& key : pressure_.keys) most = std::max(most, key.value);
  return most;
}

double GasLaw::over(double share, double volume) const {
  if (!ideal()) return share * pressure_.over;
  if (share == 0) return -pressure_.ambient;
  return amount(share) / std::max(volume, least(share)) - pressure_.ambient;
}

// V (V - b) = growth p V, with b the volume that ambient pressure alone would leave.
double GasLaw::over_after(double share, double volume, double growth) const {
  if (!ideal()) return share * pressure_.over;
  const double b = volume - growth * pressure_.ambient;
  return over(share, 0.5 * (b + std::sqrt(b * b + 4 * growth * amount(share))));
}

double GasLaw::stiffness(double share, double volume) const {
  if (!ideal() || volume < least(share)) return 0;
  return share == 0 ? 0 : amount(share) / (volume * volume);
}

double GasLaw::energy(double share, double volume) const {
  if (!ideal()) return -share * pressure_.over * (volume - volume_);
  const double rest = at_ambient(share), low = least(share);
  if (share == 0) return pressure_.ambient * volume;
  const double at = std::max(volume, low);
  return pressure_.ambient * (at - rest) - amount(share) * std::log(at / rest) -
         over(share, at) * std::min(0.0, volume - low);
}

Gas::Gas(const Cloth& cloth, const Particles& particles) : law_(cloth.pressure, 0) {
  const EnclosingSurface surface = enclosing_surface(cloth);
  triangles_ = surface.triangles;
  first_.push_back(0);
  for (const std::vector<int>& members : surface.members) {
    for (const int number : members) members_.push_back({particles.place(number), number});
    first_.push_back(int(members_.size()));
  }
  around_first_.assign(std::size_t(points()) + 1, 0);
  for (const auto& t : triangles_)
    for (const int p : t) ++around_first_[std::size_t(p) + 1];
  std::partial_sum(around_first_.begin(), around_first_.end(), around_first_.begin());
  around_.resize(3 * triangles_.size());
  std::vector<int> next = around_first_;
  for (int t = 0; t < triangles(); ++t)
    for (const int p : triangles_[std::size_t(t)]) around_[std::size_t(next[std::size_t(p)]++)] = t;

  // A part that looks inwards is turned over.
  Work all = work();
  look(placed_vertices(cloth.mesh), all);
  const std::vector<int> part = parts_of(surface);
  std::vector<double> volumes(std::size_t(points()), 0);
  for (int t = 0; t < triangles(); ++t)
    volumes[std::size_t(part[std::size_t(t)])] += measure({t, t + 1}, all);
  for (std::size_t t = 0; t < triangles_.size(); ++t)
    if (volumes[std::size_t(part[t])] < 0) std::swap(triangles_[t][1], triangles_[t][2]);
  volume_ = look(placed_vertices(cloth.mesh), all);
  law_ = GasLaw(cloth.pressure, volume_);
}

std::size_t Gas::bytes() const {
  return triangles_.size() * sizeof triangles_[0] + members_.size() * sizeof(Member) +
         (first_.size() + around_first_.size() + around_.size()) * sizeof(int);
}

Gas::Work Gas::work() const {
  Work work;
  work.points.resize(std::size_t(points()));
  work.gradients.resize(std::size_t(points()));
  work.normals.resize(triangles_.size());
  return work;
}

void Gas::gather(const Rows& x, RowSpan span, Work& work) const {
  for (int p = span.begin; p < span.end; ++p) {
    Vec3 sum{};
    for (const auto& [place, number] : members(p))
      sum = plus(sum,
                 {x.at(0, place.j, place.i), x.at(1, place.j, place.i), x.at(2, place.j, place.i)});
    work.points[std::size_t(p)] = times(sum, 1 / double(members(p).size()));
  }
}

// About the first point, which is near: far from zero, products of positions would cancel.
double Gas::measure(RowSpan span, Work& work) const {
  const Vec3& origin = work.points[0];
  double sum = 0;
  for (int t = span.begin; t < span.end; ++t) {
    const auto& [i, j, k] = triangles_[std::size_t(t)];
    const Vec3& a = work.points[std::size_t(i)];
    const Vec3 normal = normal_of(a, work.points[std::size_t(j)], work.points[std::size_t(k)]);
    work.normals[std::size_t(t)] = normal;
    sum += dot(minus(a, origin), normal);
  }
  return sum;
}

void Gas::derive(RowSpan span, Work& work) const {
  for (int p = span.begin; p < span.end; ++p) {
    Vec3 sum{};
    for (int n = around_first_[std::size_t(p)]; n < around_first_[std::size_t(p) + 1]; ++n)
      sum = plus(sum, work.normals[std::size_t(around_[std::size_t(n)])]);
    work.gradients[std::size_t(p)] = times(sum, 1 / (6 * double(members(p).size())));
  }
}

double Gas::look(const Rows& x, Work& work) const {
  gather(x, {0, points()}, work);
  return finish(work);
}

double Gas::look(const std::vector<Vec3>& x, Work& work) const {
  for (int p = 0; p < points(); ++p) {
    Vec3 sum{};
    for (const Member& m : members(p)) sum = plus(sum, x[std::size_t(m.number)]);
    work.points[std::size_t(p)] = times(sum, 1 / double(members(p).size()));
  }
  return finish(work);
}

double Gas::finish(Work& work) const {
  const double sixfold = measure({0, triangles()}, work);
  derive({0, points()}, work);
  return sixfold / 6;
}

double Gas::area(const Work& work) const {
  double sum = 0;
  for (const Vec3& n : work.normals) sum += 0.5 * length(n);
  return sum;
}

// A vertex's second derivatives are sixths of the ways between the third corners of the triangles at each edge,
// which the sides across from it add up to twice.
double Gas::turning(const Work& work, int point) const {
  double sum = 0;
  for (int n = around_first_[std::size_t(point)]; n < around_first_[std::size_t(point) + 1]; ++n) {
    const auto& t = triangles_[std::size_t(around_[std::size_t(n)])];
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = t[(k + 1) % 3], b = t[(k + 2) % 3];
      if (t[k] != point) continue;
      const Vec3 side = minus(work.points[std::size_t(a)], work.points[std::size_t(b)]);
      sum += length(side) / 3;
    }
  }
  return sum / double(members(point).size());
}

}  // namespace weft::physics
