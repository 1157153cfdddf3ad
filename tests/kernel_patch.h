// What the tests of kernels work on.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "physics/kernels/kernels.h"
#include "physics/kernels/lattice.h"
#include "physics/model/lattice/lattice.h"
#include "weft/random.h"

namespace weft::physics {

inline constexpr int kRows = 3;    // rows that a kernel can join
inline constexpr int kGuard = 16;  // zero lanes that springs along a row read before it

// All that kernels touch: a few rows of one random sheet, the same for every instruction set.
struct Patch {
  int columns, stride;
  Rows x, v, f, previous;
  Rows
      carry;  // the two sums that fused kernels carry from row to row, and a row that nothing changes
  AlignedArray<float> w, row_w, width, inverse_width, lambda, scratch;
  AlignedArray<std::int32_t> lanes, alive;

  Patch(int columns_, float padding)
      : columns(columns_),
        stride(row_stride(columns_)),
        x(kRows, stride),
        v(kRows, stride),
        f(kRows, stride),
        previous(kRows, stride),
        carry(kRows, stride),
        w(std::size_t(kRows) * stride),
        row_w(kRows),
        width(std::size_t(stride)),
        inverse_width(std::size_t(stride)),
        lambda(std::size_t(kRows) * stride),
        scratch(kGuard + 3 * std::size_t(stride)),
        lanes(2 * std::size_t(stride)),
        alive(std::size_t(kPlainStencils * kRows) * stride) {
    Random random(5, std::uint64_t(columns));
    for (int i = 0; i < stride; ++i)
      width[std::size_t(i)] = inverse_width[std::size_t(i)] = i < columns ? 1 : padding;
    for (int j = 0; j < kRows; ++j)
      for (int i = 0; i < stride; ++i) {
        const bool used = i < columns;
        for (Rows* rows : {&x, &v, &f, &previous, &carry})
          for (int axis = 0; axis < 3; ++axis)
            rows->at(axis, j, i) = used ? float(random.symmetric()) : padding;
        if (used) {
          x.at(0, j, i) += float(i);
          x.at(1, j, i) += float(j);
          // One particle in eight is pinned.
          w[std::size_t(j) * stride + i] = random.unit() < 0.125 ? 0 : float(0.5 + random.unit());
        }
      }
    for (int j = 0; j < kRows; ++j)
      for (int i = 0; i < stride; ++i)
        lambda[std::size_t(j) * stride + i] = i < columns ? float(random.symmetric()) : padding;
    // One constraint in four is torn.
    const int reach[kPlainStencils] = {1, 0, 1, 1, 2, 0};
    for (int f = 0; f < kPlainStencils; ++f)
      for (int j = 0; j < kRows; ++j)
        for (int i = 0; i < columns - reach[f]; ++i)
          alive[std::size_t(f * kRows + j) * stride + i] = random.unit() < 0.25 ? 0 : -1;
    // Two coincident particles: a spring without a direction.
    for (int axis = 0; axis < 3; ++axis) x.at(axis, 0, 1) = x.at(axis, 0, 0);
  }

  // Has columns at the sides count half, and particles there weigh half.
  void halve_sides() {
    for (const int i : {0, columns - 1}) {
      width[std::size_t(i)] = 0.5f;
      inverse_width[std::size_t(i)] = 2;
      for (int j = 0; j < kRows; ++j) w[std::size_t(j) * stride + i] *= 2;
    }
  }

  // Gives all particles one inverse mass, none pinned.
  void weigh_alike() {
    for (int j = 0; j < kRows; ++j) {
      row_w[std::size_t(j)] = 0.8f;
      for (int i = 0; i < columns; ++i) w[std::size_t(j) * stride + i] = 0.8f;
    }
  }

  const float* weights(int j) { return w.data() + std::size_t(j) * stride; }

  // The bits of all that belongs to particles, and whether they are numbers.
  std::vector<std::uint32_t> bits(bool& numbers) const {
    std::vector<std::uint32_t> all;
    const auto add = [&](float value) {
      numbers &= std::isfinite(value);
      all.push_back(std::bit_cast<std::uint32_t>(value));
    };
    for (const Rows* rows : {&x, &v, &f, &previous, &carry})
      for (int axis = 0; axis < 3; ++axis)
        for (int j = 0; j < kRows; ++j)
          for (int i = 0; i < columns; ++i) add(rows->at(axis, j, i));
    for (int j = 0; j < kRows; ++j)
      for (int i = 0; i < columns; ++i) add(lambda[std::size_t(j) * stride + i]);
    return all;
  }
};

inline Advance advance() {
  return {0.01f, 0.008f, 0.98f, 0.01f, -0.0981f, 0.003f, 0.02f};
}

// Calls visit(number, axis, lane, where a fused kernel keeps it): what rows carry lies in blocks as wide as
// the kernel's vectors.
template <class Visit>
void for_each_carried(const KernelTable& k, int stride, Visit&& visit) {
  int width = 1;
  for (const auto& [simd, lanes] : {std::pair(Simd::sse2, 4), {Simd::avx2, 8}, {Simd::avx512, 16}})
    if (simd_available(simd) && &kernel_table(simd) == &k) width = lanes;
  for (int number = 0; number < 2; ++number)
    for (int axis = 0; axis < 3; ++axis)
      for (int i = 0; i < stride; ++i)
        visit(number, axis, i,
              std::size_t((i / width * 6 + number * 3 + axis) * width + i % width));
}

// Calls a fused kernel with what rows carry in its own order.
template <class Kernel, class Rows>
void call_carrying(const KernelTable& k, Kernel kernel, Rows& r, Patch& p) {
  AlignedArray<float> carried(6 * std::size_t(p.stride));
  for_each_carried(k, p.stride, [&](int number, int axis, int i, std::size_t at) {
    carried[at] = p.carry.at(axis, number, i);
  });
  r.carry = carried.data();
  (k.lattice.*kernel)(r);
  for_each_carried(k, p.stride, [&](int number, int axis, int i, std::size_t at) {
    p.carry.at(axis, number, i) = carried[at] + 0.0f;  // a zero's sign means nothing here
  });
}

inline void fill(PlainRows& r, Patch& p, int begin, int end, bool torn) {
  for (int f = 0; f < kPlainStencils; ++f)
    r.alive[f] = torn ? p.alive.data() + std::size_t(f * kRows) * p.stride : nullptr;
  r.begin = begin;
  r.end = end;
  r.rows = kRows;
  r.columns = p.columns;
  r.stride = p.stride;
  r.x = p.x.row(0);
  r.v = p.v.row(0);
  r.w = p.weights(0);
  r.sides = p.width[0] < 1;
  r.width = p.width.data();
  r.inverse_width = p.inverse_width.data();
}

// Rows begin … end-1 of the patch with the six stencils of a plain cloth; given overlong, springs past
// tear_length are told of.
inline void spring_rows(const KernelTable& k, Patch& p, bool damped, bool torn, int begin, int end,
                        float tear_length = 0, std::uint8_t* overlong = nullptr, float alike = 0,
                        const Left& left = {}) {
  std::vector<SpringConstants> springs;
  for (int j = 0; j < kRows; ++j) {
    const std::pair<int, SpringConstants> of_each[kPlainStencils] = {
        {0, {70, 63, 0.4f}}, {1, {71, 60, 0.4f}}, {1, {40, 57, 0.4f}},
        {1, {41, 56, 0.4f}}, {0, {20, 41, 0.4f}}, {2, {20, 39, 0.4f}}};
    for (const auto& [dj, c] : of_each) {
      springs.push_back(j + dj < kRows ? c : SpringConstants{});
      if (overlong && j + dj < kRows) springs.back().taut = 1 / tear_length;
    }
  }
  SpringRows r{};
  fill(r, p, begin, end, torn);
  r.constants = springs.data();
  r.damped = damped;
  r.overlong = overlong;
  r.alike = alike;
  r.advance = advance();
  r.left = left;
  call_carrying(k, &LatticeKernels::spring_rows, r, p);
}

}  // namespace weft::physics
