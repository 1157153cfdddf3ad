#include "physics/contact/body/feature_probe.h"

#include "physics/contact/body/beside_each_other.h"
#include "physics/contact/body/body_surface.h"

namespace weft::physics {
namespace {

// What may come near is known so much farther than a triangle's reach, as a share of it; and triangles may grow so
// much longer until it is looked for again.
constexpr double kMargin = 0.5, kGrown = 1.1;

}  // namespace

FeatureProbe::FeatureProbe(const BodySurface& surface, const ClothParts& parts)
    : particles_(parts.particles),
      kernels_(parts.kernels.sheets),
      groups_(std::size_t(parts.particles.rows)),
      group_of_(groups_.size()) {
  for (int j = 0; j < particles_.rows; ++j) {
    std::vector<Group>& groups = groups_[std::size_t(j)];
    group_of_[std::size_t(j)].resize(std::size_t(particles_.count(j)));
    for (std::vector<int>& lanes :
         beside_each_other(particles_, j, kGroupWidth * surface.mean_edge())) {
      for (const int i : lanes) group_of_[std::size_t(j)][std::size_t(i)] = int(groups.size());
      groups.push_back({std::move(lanes), {}, 0});
    }
  }
}

std::span<const int> FeatureProbe::about(const ColliderRow& row, const Corners& c, double edge,
                                         int j, int i) {
  const AboutTriangle triangle = about_triangle(row.body, c, row.offset, edge);
  const int number = group_of_[std::size_t(j)][std::size_t(i)];
  Group& group = groups_[std::size_t(j)][std::size_t(number)];
  if (!group.near.know(triangle, row.time)) renew(group, row, triangle, j);
  return group.near.about(kernels_, triangle, row.time);
}

void FeatureProbe::renew(Group& group, const ColliderRow& row, const AboutTriangle& triangle,
                         int j) const {
  AlignedBox all;
  for (const int i : group.lanes) all.add(row.into(row.about_place(particles_.position(j, i))));
  const double most = kGrown * triangle.most;
  all = all.grown(most / kSmallFeature);
  all.add(triangle.box);
  const Vec3 middle = times(plus(all.low, all.high), 0.5);
  group.triangle = row.body.now.nearest(middle, group.triangle).triangle;
  group.near.find(row.body.now, row.time, all, (1 + kMargin) * triangle.reach, most,
                  group.triangle);
}

void FeatureProbe::forget() {
  for (std::vector<Group>& row : groups_)
    for (Group& group : row) group.near = {};
}

std::size_t FeatureProbe::bytes() const {
  std::size_t bytes = 0;
  for (const std::vector<Group>& row : groups_)
    for (const Group& group : row)
      bytes += sizeof(Group) + 2 * group.lanes.size() * sizeof(int) + group.near.bytes();
  return bytes;
}

}  // namespace weft::physics
