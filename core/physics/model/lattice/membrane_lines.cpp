// The lines of a membrane (membrane_lines.h).
#include "physics/model/lattice/membrane_lines.h"

#include <algorithm>
#include <cmath>

#include "physics/model/push.h"

namespace weft::physics {
namespace {

// Rows that one thread looks at together, and what a particle takes, for sizing tasks only.
constexpr int kRowsTogether = 16;
constexpr double kParticleNs = 1.5;

}  // namespace

MembraneLines::MembraneLines(const LatticeParts& parts)
    : parts_(parts),
      hu_(spacing_u(parts.cloth.grid)),
      hv_(spacing_v(parts.cloth.grid)),
      diagonals_(guarded<float>()) {
  if (parts.tearing) sheared_ = guarded<std::int32_t>();
  if (damped()) antidiagonals_ = guarded<float>();
  if (!looks_at_edges()) return;
  along_ = guarded<float>();
  across_ = guarded<float>();
  const int groups = (parts.lattice.rows + kBatchLines - 1) / kBatchLines;
  turned_ = AlignedArray<float>(std::size_t(groups) * turned_columns(parts.lattice.columns) *
                                kBatchLines);
  share_ = AlignedArray<float>(std::size_t(parts.lattice.stride));
  std::fill_n(share_.data(), parts.lattice.columns, 0.5f);
  share_[0] = share_[std::size_t(parts.lattice.columns) - 1] = 1;
  const Membrane& m = parts.cloth.membrane;
  const double u = m.coupling / (m.warp + std::abs(m.coupling)) * hu_ * hu_ / (hv_ * hv_);
  const double v = m.coupling / (m.weft + std::abs(m.coupling)) * hv_ * hv_ / (hu_ * hu_);
  for (int j = 0; j < parts.lattice.rows; ++j) {
    const double before = gradient(j - 1), after = gradient(j);
    coupling_.push_back(
        {float(u * before / (before + after)), float(u * after / (before + after)), float(v)});
  }
}

template <class T>
AlignedArray<T> MembraneLines::guarded() const {
  const Lattice& l = parts_.lattice;
  return AlignedArray<T>(2 * kGuard + std::size_t(l.rows) * std::size_t(l.stride));
}

std::size_t MembraneLines::bytes() const {
  return (diagonals_.size() + antidiagonals_.size() + along_.size() + across_.size() +
          share_.size() + turned_.size() + sheared_.size()) *
             sizeof(float) +
         coupling_.size() * sizeof(MembraneSquares::Coupling);
}

double MembraneLines::gradient(int j) const {
  const int rows = parts_.lattice.rows;
  return j >= 0 && j + 1 < rows ? 1 - parts_.cloth.stiffness_gradient * (j + 0.5) / (rows - 1) : 0;
}

void MembraneLines::prepare(double dt) {
  dt_ = dt;
  rate_ = parts_.cloth.membrane.damping / dt;
}

double MembraneLines::compliance(const Stencil& f, int j, double share) const {
  constexpr double kLeast = 1e-12;  // N/m
  const Membrane& m = parts_.cloth.membrane;
  const double area = hu_ * hv_, coupling = std::abs(m.coupling);
  double stiffness = 0;  // [N/m³]
  if (f.kind == Kind::shear)
    stiffness = std::max(kLeast, m.shear * gradient(j)) / (2 * area);
  else if (f.dj == 0)
    stiffness = area * std::max(kLeast, (m.warp + coupling) * (gradient(j - 1) + gradient(j)) / 2) /
                std::pow(hu_, 4);
  else
    stiffness =
        area * std::max(kLeast, (m.weft + coupling) * gradient(j) * share) / std::pow(hv_, 4);
  const double h = dt_ * implicit_share(parts_.scene.solver);
  return 1 / (stiffness * (1 + rate_) * h * h);
}

MembraneSquares MembraneLines::rows(int begin, int end, const Rows* corrections) {
  Lattice& l = parts_.lattice;
  const Membrane& m = parts_.cloth.membrane;
  const double coupling = std::abs(m.coupling);
  MembraneSquares r{};
  r.begin = begin;
  r.end = end;
  r.rows = l.rows;
  r.columns = l.columns;
  r.stride = l.stride;
  r.x = l.x.row(0);
  if (corrections) r.u = corrections->row(0);
  r.diagonals = r.antidiagonals = diagonals_.data() + kGuard;
  if (damped()) {
    r.antidiagonals = antidiagonals_.data() + kGuard;
    r.rate = float(rate_ / (1 + rate_));
    r.start = start_of(parts_, dt_);
  }
  r.square_u = float(hu_ * hu_);
  r.square_v = float(hv_ * hv_);
  if (looks_at_edges()) {
    r.along = along_.data() + kGuard;
    r.across = across_.data() + kGuard;
    r.keep_u = float(coupling / (m.warp + coupling));
    r.keep_v = float(coupling / (m.weft + coupling));
    r.coupling = coupling_.data();
    r.share = share_.data();
  }
  if (sheared_.size() > 0) {
    for (std::size_t f = 0; f < 4; ++f) r.alive[f] = parts_.stencils[f].links->row(0);
    r.sheared = sheared_.data() + kGuard;
  }
  return r;
}

void MembraneLines::look(LineBatches& batches, const Rows* corrections) {
  const int all = parts_.lattice.rows, columns = parts_.lattice.columns;
  batches.share_out((all + kRowsTogether - 1) / kRowsTogether,
                    kParticleNs * kRowsTogether * columns, [&](int n, BatchMemory&) {
                      const int begin = n * kRowsTogether;
                      const int end = std::min(begin + kRowsTogether, all);
                      parts_.kernels.lattice.membrane_squares(rows(begin, end, corrections));
                    });
}

const float* MembraneLines::squares(const Stencil& f, int row) const {
  if (f.kind == Kind::shear)
    return row_of(f.di < 0 && damped() ? antidiagonals_ : diagonals_, row) - f.near();
  return looks_at_edges() ? row_of(across_, row) : nullptr;
}

const float* MembraneLines::turned(int group, LineBatches& batches) {
  if (!looks_at_edges()) return nullptr;
  float* lanes =
      turned_.data() + std::size_t(group) * turned_columns(parts_.lattice.columns) * kBatchLines;
  batches.turn(along_.data() + kGuard, nullptr, group, lanes);
  return lanes;
}

const std::int32_t* MembraneLines::sheared(int row) const {
  return sheared_.size() > 0 ? row_of(sheared_, row) : nullptr;
}

}  // namespace weft::physics
