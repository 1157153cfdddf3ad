#include "physics/contact/body/body_probe.h"

#include <algorithm>
#include <cmath>

#include "physics/contact/body/beside_each_other.h"
#include "physics/contact/body/body_surface.h"

namespace weft::physics {
namespace {

// Of the body's mean edge.
constexpr double kMargin = 1;  // what may come near is known so much farther than is needed
constexpr double kFast = 4;    // what goes farther in a substep than this is looked at one by one

void put(Rows& rows, int j, int i, const Vec3& value) {
  for (int k = 0; k < 3; ++k) rows.at(k, j, i) = float(value[std::size_t(k)]);
}

}  // namespace

BodyProbe::BodyProbe(const BodySurface& surface, const ClothParts& parts)
    : surface_(surface),
      kernels_(parts.kernels.bodies),
      stride_(parts.particles.stride),
      groups_(std::size_t(parts.particles.rows)),
      known_(groups_.size() * std::size_t(stride_)),
      normal_(parts.particles.rows, stride_),
      normal_before_(parts.particles.rows, stride_),
      velocity_(surface.moves() ? parts.particles.rows : 0, stride_),
      distance_(known_.size()),
      distance_before_(known_.size()) {
  for (int j = 0; j < parts.particles.rows; ++j) {
    for (std::vector<int>& lanes :
         beside_each_other(parts.particles, j, kGroupWidth * surface.mean_edge()))
      groups_[std::size_t(j)].push_back({std::move(lanes), {}, 0});
    const std::size_t first = lane(j, 0);
    found_.push_back({distance_.data() + first, normal_.row(j), distance_before_.data() + first,
                      normal_before_.row(j),
                      surface.moves() ? ConstRow3(velocity_.row(j)) : ConstRow3{}});
  }
}

void BodyProbe::forget() {
  std::fill(known_.begin(), known_.end(), Known{});
  for (std::vector<Group>& row : groups_)
    for (Group& group : row) group.near = {};
}

std::size_t BodyProbe::bytes() const {
  std::size_t bytes = known_.size() * (sizeof(Known) + 2 * sizeof(float)) + normal_.bytes() +
                      normal_before_.bytes() + velocity_.bytes();
  for (const std::vector<Group>& row : groups_)
    for (const Group& group : row)
      bytes += sizeof(Group) + group.lanes.size() * sizeof(int) + group.near.bytes();
  return bytes;
}

void BodyProbe::look(ColliderRow& row, int j, const Substep& s) {
  NearTriangles::Placed now, before;
  NearTriangles::Nearest found;
  for (Group& group : groups_[std::size_t(j)]) {
    now.done = before.done = false;
    for (const int i : group.lanes)
      if (row.w[i] > 0) look({row, row.body, s, group, now, before, found}, j, i);
  }
  row.shape.found = &found_[std::size_t(j)];
}

BodyProbe::Path BodyProbe::path(const Look& look, int i) const {
  const ColliderRow& r = look.row;
  const Vec3 v{r.v.x[i], r.v.y[i], r.v.z[i]};
  const Vec3 off = r.about_place({r.x.x[i], r.x.y[i], r.x.z[i]});
  const Vec3 p = r.into(off), way = r.into(times(minus(v, r.carried(off, v)), r.dt));
  constexpr double kRounding = 1 + 1e-6;  // kernels see what is farther in single precision
  const double limit = std::max(double(r.offset) + r.bias, length(way) + look.body.travel);
  return {minus(p, way), p, limit * kRounding};
}

void BodyProbe::look(const Look& look, int j, int i) {
  const std::size_t at = lane(j, i);
  Known& known = known_[at];
  NearTriangles& near = look.group.near;
  const double time = look.s.time;
  const Path path = this->path(look, i);
  const Vec3& p = path.now;
  double least = this->least(known, near, p, time);
  if (least <= path.limit && worn(near, p, time, path.limit)) {
    renew(look, j);
    least = this->least(known, near, p, time);
  }
  if (least <= path.limit) {
    near.nearest(kernels_, near.along().seen(p, time), time, look.now, look.found);
    if (least > 0 && look.found.least > path.limit)
      keep(known, near, p, time, least = look.found.least);
  }
  if (least > path.limit) {
    distance_[at] = float(least);
    return;
  }
  BodyPassage::Meeting m =
      look.body.meet(path.before, p, [&](const BodyMoment& moment, const Vec3& q) {
        return nearest(look, &moment == &look.body.now, q, known);
      });
  if (!m.knows_before && look.row.resolved && m.now.distance < look.row.offset)
    m.before = nearest(look, false, path.before, known);
  distance_[at] = float(m.now.distance);
  distance_before_[at] = float(m.before.distance);
  put(normal_, j, i, look.row.out_of(m.now.normal));
  put(normal_before_, j, i, look.row.out_of(m.before.normal));
  if (look.body.moves())
    put(velocity_, j, i,
        look.row.out_of(times(look.body.way(m.now.triangle, m.now.weights), 1 / look.s.dt)));
}

double BodyProbe::least(const Known& known, const NearTriangles& near, const Vec3& p,
                        double time) const {
  if (!near.along().lasts(time)) return -1e300;
  return known.least - length(minus(near.along().seen(p, time), known.seen)) -
         near.stray() * std::abs(time - known.time);
}

bool BodyProbe::worn(const NearTriangles& near, const Vec3& p, double time, double limit) const {
  if (!near.along().lasts(time)) return true;
  const double wanted = std::min(limit, kFast * surface_.mean_edge());
  return near.along().since() != time && near.others_from(near.along().seen(p, time)) < wanted;
}

void BodyProbe::keep(Known& known, const NearTriangles& near, const Vec3& p, double time,
                     double least) const {
  known.seen = near.along().seen(p, time);
  known.time = time;
  known.least = least;
}

// What was known of how far particles are goes on from what was found before to what is found now.
void BodyProbe::renew(const Look& look, int j) {
  Group& group = look.group;
  const double time = look.s.time;
  const double last =
      std::max(std::min(time, group.near.along().end()), group.near.along().begin());
  const double travel = surface_.travel(last, time);
  AlignedBox about;
  double reach = 0;
  for (const int i : group.lanes) {
    if (!(look.row.w[i] > 0)) continue;
    const Path path = this->path(look, i);
    Known& known = known_[lane(j, i)];
    known.least = least(known, group.near, path.now, last) - travel;
    known.seen = path.now;
    known.time = time;
    about.add(path.now);
    reach = std::max(reach, path.limit);
  }
  const double edge = surface_.mean_edge();
  look.now.done = look.before.done = false;
  group.near.find(look.body.now, time, about, std::min(reach, kFast * edge) + kMargin * edge,
                  group.triangle);
}

// Now, or before the substep. What is found now is what is kept.
BodyMoment::Point BodyProbe::nearest(const Look& look, bool now, const Vec3& p,
                                     Known& known) const {
  const NearTriangles& near = look.group.near;
  const BodyMoment& moment = now ? look.body.now : look.body.before;
  const double time = now ? look.s.time : look.s.time - look.s.dt;
  const Vec3 seen = near.along().seen(p, time);
  NearTriangles::Nearest& found = look.found;
  if (!now && near.along().lasts(time)) near.nearest(kernels_, seen, time, look.before, found);
  const bool known_by_list = (now || near.along().lasts(time)) && found.known;
  const BodyMoment::Point point =
      known_by_list ? moment.nearest_among(found.all(), p) : moment.nearest(p, known.triangle);
  known.triangle = point.triangle;
  if (now) {
    keep(known, near, p, time, std::min(point.distance, near.others_from(seen)));
    look.group.triangle = point.triangle;
  }
  return point;
}

}  // namespace weft::physics
