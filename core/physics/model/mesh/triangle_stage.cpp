// A triangle belongs to the first row that it reaches, and is evaluated there. What it exerts on later rows
// stays in their records (kernels/mesh.h), so that a row is finished, and moved, as soon as its own
// triangles are done. Batches hold triangles that share no vertex: their forces are added in one order,
// however many lanes go at once.
#include "physics/model/mesh/triangle_stage.h"

#include <algorithm>
#include <cassert>

#include "physics/kernels/mesh.h"
#include "physics/model/mesh/batches.h"
#include "physics/model/push.h"
#include "physics/model/remainders.h"

namespace weft::physics {
namespace {

// What the stage does with such a material.
std::string words_of(const MeshMaterial& m) {
  std::string forces;
  if (m.membrane) forces = "membrane forces";
  if (m.stiffness > 0 || m.spring_damping > 0) forces = "springs along edges";
  if (m.bends) forces += forces.empty() ? "bending" : " and bending";
  if (forces.empty()) forces = "no forces";
  return forces + (m.damped() ? " with damping" : "") + ", leapfrog step";
}

class TriangleStage final : public Leapfrog<RowStage>, private TornParts {
 public:
  TriangleStage(const ClothParts& parts, const MeshOrder& order,
                const std::vector<RestTriangle>& triangles, const MeshMaterial& material,
                MeshTearing* tearing)
      : Leapfrog(parts, std::make_shared<Remainders>(), "triangles", words_of(material),
                 material.bends ? 2 : 1, std::int64_t(triangles.size()), "triangles"),
        parts_(parts),
        triangles_(triangles),
        tearing_(tearing),
        damped_(material.damped()),
        ring_(reach + 1) {
    fill(material);
    forces_.bows = is_curved(triangles);
    const Batches all = batches_of(order, triangles, material.bends ? 6 : 3);
    for (const std::vector<int>& one : all.elements) batches_.push_back(batch_of(one, order));
    first_ = all.first;
    if (!tearing) return;
    find_places(all.elements);
    tearing->tell(*this);
  }

  void reserve_slots(int slots) override {
    for (AlignedArray<float>* records : {&position_, &velocity_, &force_})
      if (records != &velocity_ || damped_)
        *records = AlignedArray<float>(std::size_t(slots) * slot_floats());
    loaded_.assign(std::size_t(slots), 0);
  }
  std::size_t bytes() const override {
    return Leapfrog::bytes() + batches_.size() * sizeof(MeshBatch) + place_.size() * sizeof(int) +
           (position_.size() + velocity_.size() + force_.size()) * sizeof(float);
  }

  void start(const Substep& s) override { loaded_[std::size_t(s.slot)] = 0; }

  void run(int j, const Substep& s) override {
    Particles& p = parts_.particles;
    int& loaded = loaded_[std::size_t(s.slot)];
    if (j == 0) loaded = 0;
    for (loaded = std::max(loaded, j); loaded < std::min(j + ring_, p.rows); ++loaded)
      parts_.kernels.mesh.mesh_load(row(loaded, s));
    MeshForces f = forces_;
    f.batches = batches_.data() + first_[std::size_t(j)];
    f.count = first_[std::size_t(j) + 1] - first_[std::size_t(j)];
    f.position = records(position_, s);
    f.velocity = damped_ ? records(velocity_, s) : nullptr;
    f.force = records(force_, s);
    parts_.kernels.mesh.mesh_forces(f);
    parts_.kernels.mesh.mesh_move(row(j, s));
  }

 private:
  void fill(const MeshMaterial& m) {
    forces_.membrane = m.membrane;
    forces_.c11 = float(m.c11), forces_.c22 = float(m.c22), forces_.c12 = float(m.c12);
    forces_.c66 = float(m.c66), forces_.damping = float(m.damping);
    forces_.stiffness = float(m.stiffness), forces_.spring_damping = float(m.spring_damping);
    forces_.bends = m.bends, forces_.bend_damping = float(m.bend_damping);
  }

  MeshBatch batch_of(const std::vector<int>& chosen, const MeshOrder& order) const {
    MeshBatch b{};
    const int nobody = ring_ * parts_.particles.stride;
    for (auto& corner : b.corner) std::fill(std::begin(corner), std::end(corner), nobody);
    for (std::size_t n = 0; n < chosen.size(); ++n) {
      const RestTriangle& r = triangles_[std::size_t(chosen[n])];
      for (std::size_t k = 0; k < 6; ++k)
        if (const int c = r.corner[k]; c >= 0)
          b.corner[k][n] = order.rows[std::size_t(c)] % ring_ * parts_.particles.stride +
                           order.lanes[std::size_t(c)];
      physics::set_triangle(b, n, r);
    }
    return b;
  }

  void find_places(const std::vector<std::vector<int>>& batches) {
    place_.resize(triangles_.size());
    for (std::size_t b = 0; b < batches.size(); ++b)
      for (std::size_t n = 0; n < batches[b].size(); ++n)
        place_[std::size_t(batches[b][n])] = int(kBatch * b + n);
  }
  void set_edge(int edge, bool) override {
    tearing_->for_each_side(edge, [&](const MeshTearing::Side& side) {
      const RestTriangle& r = triangles_[std::size_t(side.triangle)];
      const auto place = std::size_t(place_[std::size_t(side.triangle)]);
      MeshBatch& b = batches_[place / kBatch];
      b.half[side.k][place % kBatch] = float(r.half[side.k]);
      b.area[place % kBatch] = float(r.area);
    });
  }
  void set_triangle(int triangle) override {
    const auto place = std::size_t(place_[std::size_t(triangle)]);
    physics::set_triangle(batches_[place / kBatch], place % kBatch,
                          triangles_[std::size_t(triangle)]);
  }

  // Of the rows in turn, and of nobody.
  std::size_t slot_floats() const {
    return 4 * (std::size_t(ring_) * parts_.particles.stride + 16);
  }
  float* records(AlignedArray<float>& all, const Substep& s) {
    return all.data() + std::size_t(s.slot) * slot_floats();
  }
  MeshRow row(int j, const Substep& s) {
    Particles& p = parts_.particles;
    const std::size_t at = 4 * std::size_t(j % ring_) * p.stride;
    return {p.count(j),
            p.x.row(j),
            p.v.row(j),
            p.w(j),
            records(position_, s) + at,
            damped_ ? records(velocity_, s) + at : nullptr,
            records(force_, s) + at,
            advance_of(parts_, s),
            left_->row(j)};
  }

  ClothParts parts_;
  const std::vector<RestTriangle>& triangles_;
  MeshTearing* const tearing_;  // null: it cannot
  const bool damped_;
  const int ring_;  // rows whose records are kept
  MeshForces forces_{};
  std::vector<MeshBatch> batches_;
  std::vector<int> first_;  // batch of each row
  std::vector<int> place_;  // of every triangle in the batches, where they can tear
  AlignedArray<float> position_, velocity_, force_;
  std::vector<int> loaded_;  // the next row to come into the records, of each slot
};

}  // namespace

std::unique_ptr<RowStage> make_triangles(const ClothParts& parts, const MeshOrder& order,
                                         const std::vector<RestTriangle>& triangles,
                                         const MeshMaterial& material, MeshTearing* tearing) {
  return std::make_unique<TriangleStage>(parts, order, triangles, material, tearing);
}

}  // namespace weft::physics
