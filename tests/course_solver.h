// The course's simulator in plain double precision, written from the text of seeds 001 and 004 alone: the
// truth for course scenes. Nothing here knows of Weft.
#pragma once

#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "double_vector.h"

namespace course {

using Vec = weft::oracle::Vec3;
using weft::oracle::operator+;
using weft::oracle::operator-;
using weft::oracle::operator*;
using weft::oracle::dot;
using weft::oracle::length;

// What a scene file of the course says.
struct File {
  double width = 1, height = 1;
  int columns = 25, rows = 25;
  bool vertical = false;
  double damping = 0.2;  // % of the velocity in a step
  double density = 150;  // kg/m²
  double ks = 5000;      // N/m
  bool structural = true, shearing = true, bending = true;
  std::vector<std::array<int, 2>> pinned;
  double thickness = 0.0095;  // m
  // Not keys of the file: springs never longer than 110 %, in so many passes a step over all of them, or over
  // those that are no bending springs; neighbours on the grid nearer than 2 thicknesses push each other apart.
  bool limited = false, limits_bending = true, neighbours = false;
  int limit_passes = 1;
  bool sphere = false, plane = false;
  Vec origin{0.5, 0.2, 0.5};
  double radius = 0.2, sphere_friction = 0.3;
  Vec point{}, normal{0, 1, 0};
  double plane_friction = 0.5;
};

inline std::string text_of(const Vec& v) {
  char text[96];
  std::snprintf(text, sizeof text, "[%.17g, %.17g, %.17g]", v[0], v[1], v[2]);
  return text;
}

// The file's text.
inline std::string text_of(const File& f) {
  char text[512];
  std::snprintf(text, sizeof text,
                R"({"cloth": {"width": %.17g, "height": %.17g, "num_width_points": %d,
"num_height_points": %d, "thickness": %.17g, "orientation": %d, "damping": %.17g, "density": %.17g,
"ks": %.17g, "enable_structural": %s, "enable_shearing": %s, "enable_bending": %s, "pinned": [)",
                f.width, f.height, f.columns, f.rows, f.thickness, f.vertical ? 1 : 0, f.damping,
                f.density, f.ks, f.structural ? "true" : "false", f.shearing ? "true" : "false",
                f.bending ? "true" : "false");
  std::string all = text;
  for (const auto& [i, j] : f.pinned)
    all += (all.back() == '[' ? "[" : ", [") + std::to_string(i) + ", " + std::to_string(j) + "]";
  all += "]}";
  if (f.sphere)
    all += ", \"sphere\": {\"origin\": " + text_of(f.origin) +
           ", \"radius\": " + std::to_string(f.radius) +
           ", \"friction\": " + std::to_string(f.sphere_friction) + "}";
  if (f.plane)
    all += ", \"plane\": {\"point\": " + text_of(f.point) + ", \"normal\": " + text_of(f.normal) +
           ", \"friction\": " + std::to_string(f.plane_friction) + "}";
  return all + "}";
}

struct PointMass {
  Vec position{}, last_position{}, forces{};
  bool pinned = false;
};

struct Spring {
  int a, b;
  double rest_length, ks;
  bool bending;
};

class Solver {
 public:
  explicit Solver(const File& file) : file_(file) {
    for (int j = 0; j < file.rows; ++j)
      for (int i = 0; i < file.columns; ++i) {
        const double s = i * file.width / file.columns, t = j * file.height / file.rows;
        PointMass p;
        p.position = file.vertical ? Vec{s, t, 0} : Vec{s, 1, t};
        p.last_position = p.position;
        points.push_back(p);
      }
    for (const auto& [i, j] : file.pinned) points[std::size_t(j * file.columns + i)].pinned = true;
    for (int j = 0; j < file.rows; ++j)
      for (int i = 0; i < file.columns; ++i) {
        if (file.structural) join(i, j, i - 1, j, file.ks), join(i, j, i, j - 1, file.ks);
        if (file.shearing) join(i, j, i - 1, j - 1, file.ks), join(i, j, i + 1, j - 1, file.ks);
        if (file.bending)
          join(i, j, i - 2, j, 0.2 * file.ks, true), join(i, j, i, j - 2, 0.2 * file.ks, true);
      }
  }

  // 90 frames a second of 30 steps.
  void advance_frame() {
    for (int n = 0; n < 30; ++n) step();
  }

  std::vector<PointMass> points;

 private:
  static constexpr double kStep = 1.0 / 90 / 30;  // s

  void join(int i, int j, int oi, int oj, double ks, bool bending = false) {
    if (oi < 0 || oi >= file_.columns || oj < 0) return;
    const int a = j * file_.columns + i, b = oj * file_.columns + oi;
    springs_.push_back({a, b,
                        length(points[std::size_t(a)].position - points[std::size_t(b)].position),
                        ks, bending});
  }

  void step() {
    const double mass = file_.density * file_.width * file_.height / file_.columns / file_.rows;
    for (PointMass& p : points) p.forces = mass * Vec{0, -9.8, 0};
    for (const Spring& s : springs_) {
      PointMass &a = points[std::size_t(s.a)], &b = points[std::size_t(s.b)];
      const Vec between = b.position - a.position;
      const double now = length(between);
      const Vec force = (s.ks * (now - s.rest_length) / now) * between;
      a.forces = a.forces + force;
      b.forces = b.forces - force;
    }
    for (PointMass& p : points) {
      if (p.pinned) continue;
      const Vec before = p.position;
      p.position = p.position + (1 - file_.damping / 100) * (p.position - p.last_position) +
                   (kStep * kStep / mass) * p.forces;
      p.last_position = before;
    }
    if (file_.neighbours) push_neighbours();
    for (PointMass& p : points) {
      if (p.pinned) continue;
      if (file_.sphere) meet_sphere(p);
      if (file_.plane) meet_plane(p);
    }
    for (int n = 0; file_.limited && n < file_.limit_passes; ++n)
      for (const Spring& s : springs_)
        if (file_.limits_bending || !s.bending) limit(s);
  }

  // The course's self-collision among neighbours on the grid: each moves by the mean of what its pairs ask for,
  // divided by the steps of a frame.
  void push_neighbours() {
    std::vector<Vec> moves(points.size(), Vec{});
    for (int j = 0; j < file_.rows; ++j)
      for (int i = 0; i < file_.columns; ++i)
        moves[std::size_t(j * file_.columns + i)] = push(i, j);
    for (std::size_t p = 0; p < points.size(); ++p)
      if (!points[p].pinned) points[p].position = points[p].position + (1.0 / 30) * moves[p];
  }

  Vec push(int i, int j) const {
    const Vec& here = points[std::size_t(j * file_.columns + i)].position;
    Vec sum{};
    int pairs = 0;
    for (const auto& [di, dj] : {std::array{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
      if (i + di < 0 || i + di >= file_.columns || j + dj < 0 || j + dj >= file_.rows) continue;
      const Vec off = here - points[std::size_t((j + dj) * file_.columns + i + di)].position;
      const double missing = 2 * file_.thickness - length(off);
      if (missing <= 0) continue;
      sum = sum + (missing / length(off)) * off;
      ++pairs;
    }
    return pairs > 0 ? (1.0 / pairs) * sum : sum;
  }

  // Half of what is too long goes to each end, all of it to the other of a pinned one.
  void limit(const Spring& s) {
    PointMass &a = points[std::size_t(s.a)], &b = points[std::size_t(s.b)];
    const Vec between = b.position - a.position;
    const double excess = length(between) - 1.1 * s.rest_length;
    if (excess <= 0 || (a.pinned && b.pinned)) return;
    const Vec way = (excess / length(between)) * between;
    const double share = a.pinned || b.pinned ? 1 : 0.5;
    if (!a.pinned) a.position = a.position + share * way;
    if (!b.pinned) b.position = b.position - share * way;
  }

  // The tangent point, as seen from the last position; friction shortens the way there.
  void meet_sphere(PointMass& p) const {
    const Vec out = p.position - file_.origin;
    if (length(out) >= file_.radius) return;
    const Vec tangent = file_.origin + (file_.radius / length(out)) * out;
    p.position = p.last_position + (1 - file_.sphere_friction) * (tangent - p.last_position);
  }

  // A ray from the last position; a hit moves the particle to a surface offset before the plane.
  void meet_plane(PointMass& p) const {
    constexpr double kSurfaceOffset = 1e-4;  // m
    const Vec way = p.position - p.last_position;
    const double t_max = length(way);
    if (t_max == 0) return;
    const Vec direction = (1 / t_max) * way;
    const double slope = dot(file_.normal, direction);
    if (std::abs(slope) < 1e-12) return;
    const double t = dot(file_.point - p.last_position, file_.normal) / slope;
    if (t < 0 || t > t_max) return;
    const Vec target = p.last_position + (t - kSurfaceOffset) * direction;
    p.position = p.last_position + (1 - file_.plane_friction) * (target - p.last_position);
  }

  File file_;
  std::vector<Spring> springs_;
};

}  // namespace course
