#include "physics/model/mesh/batches.h"

#include <algorithm>
#include <bit>
#include <cstdint>

#include "physics/kernels/mesh.h"

namespace weft::physics {
namespace {

constexpr std::size_t kOpen = 64;  // batches that an element may still join
constexpr int kColours = 32;

// Elements of one row, packed in their order.
std::vector<std::vector<int>> packed(const std::vector<int>& row,
                                     const std::vector<Corners>& elements) {
  std::vector<std::vector<int>> batches;
  std::vector<std::size_t> open;
  const auto apart = [&](int a, int b) {
    const Corners &p = elements[std::size_t(a)], &q = elements[std::size_t(b)];
    return std::none_of(p.begin(), p.end(), [&](int corner) {
      return corner >= 0 && std::find(q.begin(), q.end(), corner) != q.end();
    });
  };
  for (const int t : row) {
    const auto fits = [&](std::size_t b) {
      return std::all_of(batches[b].begin(), batches[b].end(), [&](int s) { return apart(s, t); });
    };
    auto at = std::find_if(open.begin(), open.end(), fits);
    if (at == open.end()) {
      if (open.size() == kOpen) open.erase(open.begin());
      at = open.insert(open.end(), batches.size());
      batches.emplace_back();
    }
    batches[*at].push_back(t);
    if (batches[*at].size() == kBatch) open.erase(at);
  }
  return batches;
}

// Of every row, the elements that reach it first.
std::vector<std::vector<int>> in_rows(const MeshOrder& order,
                                      const std::vector<Corners>& elements) {
  std::vector<std::vector<int>> rows(order.counts.size());
  for (std::size_t t = 0; t < elements.size(); ++t) {
    int first = int(rows.size());
    for (const int c : elements[t])
      if (c >= 0) first = std::min(first, order.rows[std::size_t(c)]);
    rows[std::size_t(first)].push_back(int(t));
  }
  return rows;
}

Batches all_packed(const std::vector<std::vector<int>>& rows,
                   const std::vector<Corners>& elements) {
  Batches all;
  all.first.push_back(0);
  for (const std::vector<int>& row : rows) {
    for (std::vector<int>& one : packed(row, elements)) all.elements.push_back(std::move(one));
    all.first.push_back(int(all.elements.size()));
  }
  return all;
}

// The colour of an element that no other at its corners has, if there is one: one of which the row has begun
// a batch, else the first.
int colour_of(std::uint32_t taken, const std::array<int, kColours>& in_row, int colours) {
  for (int c = 0; c < colours; ++c)
    if (!(taken >> c & 1) && in_row[std::size_t(c)] % kBatch != 0) return c;
  return std::min(std::countr_one(taken), kColours - 1);
}

}  // namespace

Batches batches_of(const MeshOrder& order, const std::vector<RestTriangle>& triangles,
                   int corners) {
  std::vector<Corners> elements;
  for (const RestTriangle& r : triangles) {
    elements.push_back(r.corner);
    std::fill(elements.back().begin() + corners, elements.back().end(), -1);
  }
  return all_packed(in_rows(order, elements), elements);
}

void set_triangle(MeshBatch& b, std::size_t n, const RestTriangle& r) {
  for (std::size_t k = 0; k < 2; ++k) b.du[k][n] = float(r.du[k]), b.dv[k][n] = float(r.dv[k]);
  b.area[n] = float(r.area);
  for (std::size_t k = 0; k < 3; ++k) {
    b.rest[k][n] = float(r.rest[k]);
    b.half[k][n] = float(r.half[k]);
    b.away[k][n] = float(r.away[k]), b.away_at[k][n] = float(r.away_at[k]);
    b.bow[k][n] = float(r.bow[k]);
    b.own[k][n] = float(r.own[k]), b.own_at[k][n] = float(r.own_at[k]);
  }
  for (std::size_t m = 0; m < 6; ++m) b.moment[m][n] = float(r.moment[m]);
}

std::vector<Batches> coloured_batches(const MeshOrder& order,
                                      const std::vector<Corners>& elements) {
  using Elements = std::vector<std::vector<int>>;  // of every row
  std::vector<Elements> colours;
  std::vector<std::uint32_t> taken(order.rows.size());
  const Elements rows = in_rows(order, elements);
  for (std::size_t j = 0; j < rows.size(); ++j) {
    std::array<int, kColours> in_row{};
    for (const int t : rows[j]) {
      std::uint32_t all = 0;
      for (const int c : elements[std::size_t(t)])
        if (c >= 0) all |= taken[std::size_t(c)];
      const auto colour = std::size_t(colour_of(all, in_row, int(colours.size())));
      if (colour == colours.size()) colours.emplace_back(rows.size());
      colours[colour][j].push_back(t);
      ++in_row[colour];
      for (const int c : elements[std::size_t(t)])
        if (c >= 0) taken[std::size_t(c)] |= std::uint32_t{1} << colour;
    }
  }
  std::vector<Batches> all;
  for (const Elements& colour : colours) {
    all.push_back(all_packed(colour, elements));
    all.back().disjoint = all.size() < kColours;
  }
  return all;
}

}  // namespace weft::physics
