// Self-collision (self_collision.h): how a pair that is too near is pushed apart.
//
//   stiff:   Δx_a = n (t - d) w_a/(w_a + w_b), the velocity into the other is lost, and the
//   tangential
//            velocity t loses up to μ times as much as was pressed (Coulomb); averaged over the
//            pairs
//   course:  Δx_a = n (t - d), averaged over the pairs and divided by the substeps, velocity
//   included
//            (seeds 001 and 004: the position before stays)
#include <algorithm>
#include <cmath>

#include "physics/plan.h"
#include "physics/self_collision/self_collision.h"

namespace weft::physics {
namespace {

constexpr float kMostPush =
    0.5f;  // of the thickness, at once: what starts intersecting comes apart slowly
constexpr float kHeld =
    1.07f;  // thicknesses that a pair is held apart: layers of a stack sink in a little
constexpr float kTiny = 1e-12f;

}  // namespace

void SelfContact::gather(std::size_t a) {
  const Site& s = pairs_.site[a];
  const Sheet& sheet = sheets_[s.cloth];
  Lattice& l = *sheet.lattice;
  Body& b = bodies_[a];
  for (int k = 0; k < 3; ++k) {
    b.x[k] = l.x.at(k, s.row, s.column);
    b.v[k] = l.v.at(k, s.row, s.column);
  }
  b.w = l.w(s.row, s.column);
  b.thickness = sheet.thickness;
}

void SelfContact::separate(std::size_t t, double dt, int since) {
  const auto a = std::size_t(touching_.owner[t]);
  const Body& p = bodies_[a];
  Body& out = separated_[a];
  out = p;
  if (p.w <= 0) return;
  const Site& site = pairs_.site[a];
  const Sheet& sheet = sheets_[site.cloth];
  float push[3] = {}, gain[3] = {};
  int count = 0;
  for (std::int32_t k = touching_.first[t]; k < touching_.first[t + 1]; ++k) {
    const std::int32_t other = touching_.neighbour[std::size_t(k)];
    const Body& q = bodies_[std::size_t(other)];
    const float thickness = 0.5f * (p.thickness + q.thickness) * (sheet.course ? 1 : kHeld);
    float d[3] = {p.x[0] - q.x[0], p.x[1] - q.x[1], p.x[2] - q.x[2]};
    const float square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    if (square >= thickness * thickness) continue;
    ++count;
    float distance = std::sqrt(square);
    if (distance < kTiny) {  // in one place: apart along y, by their order
      d[0] = d[2] = 0;
      d[1] = distance = std::size_t(other) > a ? 1.f : -1.f;
      distance = 1;
    }
    const float n[3] = {d[0] / distance, d[1] / distance, d[2] / distance};
    const float depth = thickness - (square < kTiny * kTiny ? 0 : distance);
    if (sheet.course) {
      for (int m = 0; m < 3; ++m) push[m] += n[m] * depth;
      continue;
    }
    const float share = p.w / (p.w + q.w);
    const float lift = std::min(depth, kMostPush * thickness) * share;
    const float u[3] = {p.v[0] - q.v[0], p.v[1] - q.v[1], p.v[2] - q.v[2]};
    const float into = u[0] * n[0] + u[1] * n[1] + u[2] * n[2];
    const float slide[3] = {u[0] - into * n[0], u[1] - into * n[1], u[2] - into * n[2]};
    const float sliding =
        std::sqrt(slide[0] * slide[0] + slide[1] * slide[1] + slide[2] * slide[2]);
    const float lost = std::max(0.f, -into);
    const float rubbed = sliding > kTiny ? std::min(1.f, sheet.friction * lost / sliding) : 0;
    for (int m = 0; m < 3; ++m) {
      push[m] += n[m] * lift;
      gain[m] += (n[m] * lost - slide[m] * rubbed) * share;
    }
  }
  if (count == 0) return;
  const float mean = 1 / float(count);
  // The course's push for as many substeps as have passed.
  const double steps = scene_.time.substeps > 0 ? scene_.time.substeps : scene_.time.frame / dt;
  const auto course = float(since / steps);
  for (int m = 0; m < 3; ++m) {
    const float change = push[m] * mean * (sheet.course ? course : 1);
    const float faster = sheet.course ? change / float(dt) : gain[m] * mean;
    out.x[m] += change;
    out.v[m] += faster;
  }
}

void SelfContact::scatter(std::size_t t) {
  const auto a = std::size_t(touching_.owner[t]);
  const Site& s = pairs_.site[a];
  Lattice& l = *sheets_[s.cloth].lattice;
  if (bodies_[a].w <= 0) return;
  for (int k = 0; k < 3; ++k) {
    l.x.at(k, s.row, s.column) = bodies_[a].x[k];
    l.v.at(k, s.row, s.column) = bodies_[a].v[k];
  }
}

}  // namespace weft::physics
