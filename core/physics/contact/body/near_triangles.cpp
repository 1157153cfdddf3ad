#include "physics/contact/body/near_triangles.h"

#include <cmath>

namespace weft::physics {
namespace {

constexpr double kRounding = 4e-6;  // of the extent; 64 times that of one number

int padded(int count) {
  return (count + 15) & ~15;
}

}  // namespace

void NearTriangles::find(const BodyMoment& now, double time, const AlignedBox& about, double reach,
                         int hint) {
  const BodyMoment begin = now.at_begin(), end = now.at_end();
  along_ = {now, time, hint};
  about_ = about;
  middle_ = times(plus(about.low, about.high), 0.5);
  std::vector<int> found;  // ascending
  stray_ = 0;
  double square = 1e300;  // m²; to which it is of interest how far one is
  const std::vector<BodyForm::Part>& parts = now.form().parts;
  for (std::size_t part = 0; part < parts.size(); ++part)
    parts[part].tree.nearest(
        [&](int node) {
          return along_.seen(begin.part_box(part, node), end.part_box(part, node))
              .square_from(about);
        },
        square,
        [&](int n) {
          const int triangle = parts[part].first + n;
          const Triangle from = along_.seen(begin.corners(triangle), along_.begin()),
                         to = along_.seen(end.corners(triangle), along_.end());
          AlignedBox all;
          for (std::size_t k = 0; k < 3; ++k) all.add(from[k]), all.add(to[k]);
          const double apart = all.square_from(about);
          square = std::min(square, std::max(apart, reach * reach));
          if (apart > reach * reach) return;
          found.push_back(triangle);
          for (std::size_t k = 0; k < 3; ++k)
            stray_ = std::max(stray_, length(minus(to[k], from[k])));
        });
  reach_ = std::sqrt(square);
  stray_ /= std::max(along_.end() - along_.begin(), 1e-300);
  std::sort(found.begin(), found.end());
  list(found, parts);
  many_ = numbers_.size() > kMost;
  if (many_) return;
  within_another_ = within_another(now);
  keep(begin, end);
}

void NearTriangles::list(const std::vector<int>& found, const std::vector<BodyForm::Part>& parts) {
  parts_.clear();
  numbers_.clear();
  auto next = found.begin();
  for (std::size_t n = 0; n < parts.size(); ++n) {
    const auto first = next;
    next = std::lower_bound(first, found.end(), parts[n].last);
    if (first == next) continue;
    parts_.push_back({int(n), int(numbers_.size()), int(next - first)});
    numbers_.insert(numbers_.end(), first, next);
    numbers_.resize(std::size_t(padded(int(numbers_.size()))), *first);
  }
}

// A part of which nothing is near has the points all in it, or none of them.
bool NearTriangles::within_another(const BodyMoment& now) const {
  const int parts = int(now.form().parts.size());
  auto near = parts_.begin();
  for (int n = 0; n < parts && parts > 1; ++n) {
    if (near != parts_.end() && near->number == n)
      ++near;
    else if (now.within_part(std::size_t(n), middle_))
      return true;
  }
  return false;
}

void NearTriangles::keep(const BodyMoment& begin, const BodyMoment& end) {
  const std::size_t stride = numbers_.size();
  from_.resize(9 * stride);
  way_.resize(begin.moves() ? 9 * stride : 0);
  double square = 0;
  for (std::size_t n = 0; n < stride; ++n) {
    const Triangle from = along_.seen(begin.corners(numbers_[n]), along_.begin()),
                   to = along_.seen(end.corners(numbers_[n]), along_.end());
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 at = minus(from[k], middle_), then = minus(to[k], middle_),
                 way = minus(to[k], from[k]);
      square = std::max({square, dot(at, at), dot(then, then)});
      for (std::size_t m = 0; m < 3; ++m) {
        from_[(3 * k + m) * stride + n] = float(at[m]);
        if (begin.moves()) way_[(3 * k + m) * stride + n] = float(way[m]);
      }
    }
  }
  extent_ = std::sqrt(square) + length(minus(about_.high, about_.low)) + reach_;
}

void NearTriangles::place(const BodyKernels& kernels, double time, Placed& placed) const {
  if (placed.done) return;
  placed.done = true;
  placed.slack = kernels.place_triangles(
      {int(numbers_.size()), from_.data(), way_.empty() ? nullptr : way_.data(),
       float(along_.share(time)), float(kRounding * extent_), placed.rows.data()});
}

void NearTriangles::nearest(const BodyKernels& kernels, const Vec3& seen, double time,
                            Placed& placed, Nearest& found) const {
  const double others = others_from(seen);
  found.least = many_ ? -1e300 : others;
  found.known = false;
  found.count = 0;
  if (many_ || parts_.empty()) return;
  place(kernels, time, placed);
  const Vec3 p = minus(seen, middle_);
  found.known = !within_another_;
  std::array<float, kMost + 16> squares;
  for (const Part& part : parts_) {
    const NearestOfThem one = kernels.nearest_triangles(
        {int(numbers_.size()), placed.rows.data(), numbers_.data(), part.first, part.count,
         float(p[0]), float(p[1]), float(p[2]), placed.slack, squares.data(),
         found.triangles.data() + found.count});
    found.count += one.count;
    found.least = std::min(found.least, double(one.distance) - placed.slack);
    found.known = found.known && one.distance + placed.slack <= others;
  }
}

std::size_t NearTriangles::bytes() const {
  return numbers_.capacity() * sizeof(int) + parts_.capacity() * sizeof(Part) +
         (from_.capacity() + way_.capacity()) * sizeof(float);
}

}  // namespace weft::physics
