// The cells of a membrane that kernels look at together.
#pragma once

#include "physics/kernels/row_kernels.h"

namespace weft::WEFT_KERNELS {

// The edges and diagonals of a block of cells: of positions, or of velocities.
struct Cells {
  Wide3 a, a_below, b, b_right, p, q;
  WEFT_INLINE Cells(const float* row, const float* below, std::ptrdiff_t plane) {
    const Wide3 x0 = load_planes(row, plane), right = load_planes(row + 1, plane);
    const Wide3 x1 = load_planes(below, plane), opposite = load_planes(below + 1, plane);
    a = right - x0;
    a_below = opposite - x1;
    b = x1 - x0;
    b_right = opposite - right;
    p = opposite - x0;
    q = right - x1;
  }
  // With those of corrections of the positions.
  WEFT_INLINE Cells operator+(const Cells& u) const {
    Cells sum = *this;
    sum.a = a + u.a;
    sum.a_below = a_below + u.a_below;
    sum.b = b + u.b;
    sum.b_right = b_right + u.b_right;
    sum.p = p + u.p;
    sum.q = q + u.q;
    return sum;
  }
  WEFT_INLINE Cells operator*(Wide factor) const {
    Cells product = *this;
    for (Wide3 Cells::*edge :
         {&Cells::a, &Cells::a_below, &Cells::b, &Cells::b_right, &Cells::p, &Cells::q})
      product.*edge = this->*edge * factor;
    return product;
  }
};

}  // namespace weft::WEFT_KERNELS
