#include "physics/model/mesh/strain_sweep.h"

#include <algorithm>

#include "physics/model/mesh/mesh_records.h"
#include "physics/model/push.h"

namespace weft::physics {
namespace {

class SweepStrains final : public RowStage {
 public:
  // `before`: null where a sweep damps nothing.
  SweepStrains(const ClothParts& parts, StrainColour& colour, AlignedArray<float>& records,
               const float* before, int number, StrainPass pass)
      : RowStage("gauss_seidel",
                 (pass.damps ? "damping" : "membrane") +
                     (" of triangles of colour " + std::to_string(number)),
                 1, colour.triangles, "triangles"),
        parts_(parts),
        colour_(colour),
        records_(records),
        before_(before),
        pass_(pass) {}
  Velocities velocities() const override { return Velocities::left_alone; }
  bool rows_apart() const override { return colour_.disjoint; }
  void run(int begin, int end, const Substep& s) override {
    const int first = colour_.first[std::size_t(begin)];
    const Membrane& m = parts_.cloth.membrane;
    const double h = s.dt * implicit_share(parts_.scene.solver);
    const double determinant = m.warp * m.weft - m.coupling * m.coupling;
    StrainSweep sweep{};
    sweep.batches = colour_.batches.data() + first;
    sweep.count = colour_.first[std::size_t(end)] - first;
    sweep.records = records_.data();
    sweep.before = before_;
    sweep.give[0] = float(m.weft / determinant);
    sweep.give[1] = float(m.warp / determinant);
    sweep.give[2] = float(-m.coupling / determinant);
    sweep.give[3] = float(1 / m.shear);
    sweep.dt2 = float(h * h);
    sweep.rate = float(m.damping / s.dt);
    sweep.damps = pass_.damps;
    sweep.fresh = pass_.fresh;
    if (colour_.stress.size() > 0)
      sweep.stress = colour_.stress.data() + std::ptrdiff_t(kStrains * kBatch) * first;
    if (pass_.last && colour_.midst.size() > 0)
      sweep.midst = colour_.midst.data() + std::ptrdiff_t(kStrains * kBatch) * first;
    parts_.kernels.mesh.sweep_strains(sweep);
  }

 private:
  ClothParts parts_;
  StrainColour& colour_;
  AlignedArray<float>& records_;
  const float* before_;
  StrainPass pass_;
};

StrainBatch batch_of(const std::vector<int>& chosen, int row, const Particles& p,
                     const std::vector<RestTriangle>& triangles) {
  StrainBatch b{};
  for (std::size_t c = 0; c < 3; ++c)
    for (int k = 0; k < kBatch; ++k) b.corner[c][k] = offset_of_nobody(p, row, k);
  for (std::size_t n = 0; n < chosen.size(); ++n) {
    const RestTriangle& r = triangles[std::size_t(chosen[n])];
    for (std::size_t c = 0; c < 3; ++c) b.corner[c][n] = offset_of(p, r.corner[c]);
    for (std::size_t k = 0; k < 2; ++k) b.du[k][n] = float(r.du[k]), b.dv[k][n] = float(r.dv[k]);
    b.area[n] = float(r.area);
  }
  return b;
}

}  // namespace

StrainSweeps::StrainSweeps(const ClothParts& parts, const MeshOrder& order,
                           const std::vector<RestTriangle>& triangles, AlignedArray<float>& records,
                           bool keeps_stress, bool tears)
    : parts_(parts),
      triangles_(triangles),
      records_(records),
      damps_in_one_(keeps_stress && damped()) {
  const Particles& p = parts.particles;
  if (damped()) before_ = records_of(p);
  if (keeps_stress || tears) places_.resize(triangles.size());
  std::vector<Corners> elements;
  for (const RestTriangle& r : triangles)
    elements.push_back({r.corner[0], r.corner[1], r.corner[2], -1, -1, -1});
  for (const Batches& all : coloured_batches(order, elements)) {
    StrainColour& colour = colours_.emplace_back();
    colour.first = all.first;
    colour.disjoint = all.disjoint;
    for (int j = 0; j < p.rows; ++j)
      for (int n = all.first[std::size_t(j)]; n < all.first[std::size_t(j) + 1]; ++n) {
        const std::vector<int>& chosen = all.elements[std::size_t(n)];
        const std::size_t first = colour.batches.size() * kStrains * kBatch;
        for (std::size_t k = 0; !places_.empty() && k < chosen.size(); ++k)
          places_[std::size_t(chosen[k])] = {colours_.size() - 1, first + k, j};
        colour.batches.push_back(batch_of(chosen, j, p, triangles));
        colour.triangles += std::int64_t(chosen.size());
      }
    if (keeps_stress) make_room(colour);
  }
}

void StrainSweeps::make_room(StrainColour& colour) {
  if (colour.stress.size() == 0)
    colour.stress = AlignedArray<float>(colour.batches.size() * kStrains * kBatch);
}

void StrainSweeps::follow(int triangle) {
  const RestTriangle& r = triangles_[std::size_t(triangle)];
  const Place& at = places_[std::size_t(triangle)];
  StrainBatch& b = colours_[at.colour].batches[at.first / (kStrains * kBatch)];
  const std::size_t k = at.first % (kStrains * kBatch);
  const Particles& p = parts_.particles;
  b.area[k] = float(r.area);
  for (std::size_t c = 0; c < 3; ++c)
    b.corner[c][k] = r.area > 0 ? offset_of(p, r.corner[c]) : offset_of_nobody(p, at.row, int(k));
}

void StrainSweeps::clear_stress() {
  for (StrainColour& c : colours_) std::fill_n(c.stress.data(), c.stress.size(), 0.0f);
}

void StrainSweeps::append_places_before(StageList& list) {
  if (damped()) list.stages.push_back(make_load_records(parts_, before_, 1));
}

void StrainSweeps::tell_lengths() {
  for (StrainColour& c : colours_)
    c.midst = AlignedArray<float>(c.batches.size() * kStrains * kBatch);
}

std::vector<const float*> StrainSweeps::midst() const {
  std::vector<const float*> midst;
  for (const Place& at : places_)
    if (const AlignedArray<float>& all = colours_[at.colour].midst; all.size() > 0)
      midst.push_back(all.data() + at.first);
  return midst;
}

void StrainSweeps::append(int iterations, StrainPass pass, StageList& list) {
  const int last = int(colours_.size()) - 1;
  for (int n = 0; n <= last; ++n) {
    const int c = pass.backwards ? last - n : n;
    StrainColour& colour = colours_[std::size_t(c)];
    if (iterations > 1) make_room(colour);
    list.stages.push_back(std::make_unique<SweepStrains>(
        parts_, colour, records_, pass.damps || damps_in_one_ ? before_.data() : nullptr, c, pass));
  }
}

std::size_t StrainSweeps::bytes() const {
  std::size_t bytes = before_.size() * sizeof(float) + places_.size() * sizeof(Place);
  for (const StrainColour& c : colours_)
    bytes +=
        c.batches.size() * sizeof(StrainBatch) + (c.stress.size() + c.midst.size()) * sizeof(float);
  return bytes;
}

}  // namespace weft::physics
