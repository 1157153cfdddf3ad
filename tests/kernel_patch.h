// What the tests of kernels work on.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "physics/kernels/kernels.h"
#include "physics/lattice.h"
#include "physics/random.h"

namespace weft::physics {

inline constexpr int kRows = 3;    // rows that a kernel can join
inline constexpr int kGuard = 16;  // zero lanes that springs along a row read before it

// All that kernels touch: a few rows of one random sheet, the same for every instruction set.
struct Patch {
  int columns, stride;
  Rows x, v, f, previous, carry;
  AlignedArray<float> w, row_w, lambda, scratch;
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
        lambda(std::size_t(stride)),
        scratch(kGuard + 3 * std::size_t(stride)),
        lanes(2 * std::size_t(stride)),
        alive(std::size_t(kPlainFamilies * kRows) * stride) {
    Random random(5, std::uint64_t(columns));
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
    for (int i = 0; i < stride; ++i) lambda[i] = i < columns ? float(random.symmetric()) : padding;
    // One constraint in four is torn.
    const int reach[kPlainFamilies] = {1, 0, 1, 1, 2, 0};
    for (int f = 0; f < kPlainFamilies; ++f)
      for (int j = 0; j < kRows; ++j)
        for (int i = 0; i < columns - reach[f]; ++i)
          alive[std::size_t(f * kRows + j) * stride + i] = random.unit() < 0.25 ? 0 : -1;
    // Two coincident particles: a spring without a direction.
    for (int axis = 0; axis < 3; ++axis) x.at(axis, 0, 1) = x.at(axis, 0, 0);
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
    for (int i = 0; i < columns; ++i) add(lambda[std::size_t(i)]);
    return all;
  }
};

}  // namespace weft::physics
