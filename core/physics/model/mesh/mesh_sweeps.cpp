#include "physics/model/mesh/mesh_sweeps.h"

#include <algorithm>
#include <map>

#include "physics/model/mesh/mesh_records.h"
#include "physics/model/mesh/triangle_constraint.h"
#include "physics/model/push.h"
#include "physics/step/keeper.h"

namespace weft::physics {
namespace {

struct EdgeOptions {
  int colour;
  bool fresh = true;   // the first sweep of a substep
  double longest = 0;  // > 0: a limit
  bool last = false;   // of a substep; tells lengths, if anybody asks
};

class SweepEdges final : public RowStage {
 public:
  SweepEdges(const ClothParts& parts, EdgeColour& colour, AlignedArray<float>& records,
             const EdgeOptions& options)
      : RowStage(options.longest > 0 ? "strain_limit" : "gauss_seidel",
                 "edges of colour " + std::to_string(options.colour), 1, colour.edges,
                 "constraints"),
        parts_(parts),
        colour_(colour),
        records_(records),
        options_(options) {}
  Velocities velocities() const override { return Velocities::left_alone; }
  bool rows_apart() const override { return colour_.disjoint; }
  void run(int begin, int end, const Substep& s) override {
    const int first = colour_.first[std::size_t(begin)];
    const double h = s.dt * implicit_share(parts_.scene.solver);
    EdgeSweep sweep{};
    sweep.batches = colour_.batches.data() + first;
    sweep.count = colour_.first[std::size_t(end)] - first;
    sweep.records = records_.data();
    sweep.inverse_dt2 = float(1 / (h * h));
    sweep.fresh = options_.fresh;
    sweep.longest = float(options_.longest);
    if (colour_.lambda.size() > 0 && options_.longest == 0)
      sweep.lambda = colour_.lambda.data() + std::ptrdiff_t(kBatch) * first;
    if (options_.last && colour_.midst.size() > 0)
      sweep.midst = colour_.midst.data() + std::ptrdiff_t(kBatch) * first;
    parts_.kernels.mesh.sweep_edges(sweep);
  }

 private:
  ClothParts parts_;
  EdgeColour& colour_;
  AlignedArray<float>& records_;
  EdgeOptions options_;
};

class SweepHinges final : public RowStage, private TornParts {
 public:
  SweepHinges(const ClothParts& parts, HingeColour& colour,
              const std::vector<RestTriangle>& triangles, AlignedArray<float>& records, int number,
              MeshTearing* tearing)
      : RowStage("bending", "triangles of colour " + std::to_string(number), 2, colour.count,
                 "triangles"),
        parts_(parts),
        colour_(colour),
        triangles_(triangles),
        records_(records),
        bows_(is_curved(triangles)) {
    if (!tearing) return;
    for (std::size_t n = 0; n < colour.triangles.size(); ++n)
      if (colour.triangles[n] >= 0) place_[colour.triangles[n]] = n;
    tearing->tell(*this);
  }
  std::size_t bytes() const override { return place_.size() * 8 * sizeof(int); }
  Velocities velocities() const override { return Velocities::left_alone; }
  bool rows_apart() const override { return colour_.disjoint; }
  void prepare(double dt) override {
    if (dt == dt_) return;
    dt_ = dt;
    set_matrices();
  }
  void restart() override {
    if (dt_ > 0) set_matrices();
  }
  // Matrices have the masses of when they were set: nothing of what sleeps since.
  void keep(Keeper& keeper) override {
    if (!(parts_.scene.solver.sleep > 0)) return;
    keeper(dt_);
    for (MeshBatch& b : colour_.batches) keeper(b.moment);
  }
  void run(int begin, int end, const Substep&) override {
    const int first = colour_.first[std::size_t(begin)];
    parts_.kernels.mesh.sweep_hinges({colour_.batches.data() + first,
                                      colour_.first[std::size_t(end)] - first, records_.data(),
                                      bows_});
  }

 private:
  void set_matrices() {
    for (std::size_t n = 0; n < colour_.triangles.size(); ++n)
      if (colour_.triangles[n] >= 0) set_matrix(n);
  }
  // The second order scales inverse masses while it solves, by 9/4 at most.
  void set_matrix(std::size_t n) {
    const Solver& solver = parts_.scene.solver;
    const double h = dt_ * implicit_share(solver), scale = solver.order == 2 ? 2.25 : 1;
    const Particles& p = parts_.particles;
    const RestTriangle& r = triangles_[std::size_t(colour_.triangles[n])];
    const auto matrix =
        hinge_matrix(r, h, [&](int v) { return scale * p.inverse_mass[p.lane(v)]; });
    MeshBatch& b = colour_.batches[n / kBatch];
    for (std::size_t m = 0; m < 6; ++m) b.moment[m][n % kBatch] = float(matrix[m]);
  }
  void set_triangle(int triangle) override {
    const auto found = place_.find(triangle);
    if (found == place_.end()) return;
    const std::size_t n = found->second;
    physics::set_triangle(colour_.batches[n / kBatch], n % kBatch,
                          triangles_[std::size_t(triangle)]);
    if (dt_ > 0) set_matrix(n);
  }

  ClothParts parts_;
  HingeColour& colour_;
  const std::vector<RestTriangle>& triangles_;
  AlignedArray<float>& records_;
  const bool bows_;
  std::map<int, std::size_t> place_;  // of the colour's triangles, where they can tear
  double dt_ = 0;
};

}  // namespace

MeshSweeps::MeshSweeps(const ClothParts& parts, const MeshOrder& order, const Seams& seams,
                       MeshTearing* tearing)
    : parts_(parts),
      order_(order),
      seams_(seams),
      tearing_(tearing),
      records_(records_of(parts.particles)) {}

// Places of no edge, or no more, are told the padding behind their own row, a lane each.
void MeshSweeps::put_nobody(EdgeBatch& b, std::size_t lane, int row) const {
  b.near[lane] = b.far[lane] = offset_of_nobody(parts_.particles, row, int(lane));
}

void MeshSweeps::set_edge(int edge, bool holds) {
  if (strains_)
    tearing_->for_each_side(edge,
                            [&](const MeshTearing::Side& s) { strains_->follow(s.triangle); });
  if (place_.empty()) return;
  const EdgePlace& at = place_[std::size_t(edge)];
  EdgeBatch& b = edges_[std::size_t(at.colour)].batches[at.batch];
  if (!holds) return put_nobody(b, at.lane, at.row);
  const auto [near, far] = tearing_->parts().edges.ends[std::size_t(edge)];
  b.near[at.lane] = offset_of(parts_.particles, near);
  b.far[at.lane] = offset_of(parts_.particles, far);
}

// Of what has torn before these were made.
void MeshSweeps::follow_torn() {
  for (std::size_t e = 0; tearing_ && e < tearing_->parts().edges.ends.size(); ++e)
    if (!tearing_->holds(e)) set_edge(int(e), false);
}

void MeshSweeps::make_edges(const MeshEdges& edges, double stiffness) {
  const Particles& p = parts_.particles;
  std::vector<Corners> elements;
  if (tearing_) place_.resize(edges.ends.size());
  for (const auto& [a, b] : edges.ends) elements.push_back({a, b, -1, -1, -1, -1});
  for (const Batches& all : coloured_batches(order_, elements)) {
    EdgeColour& colour = edges_.emplace_back();
    colour.first = all.first;
    colour.disjoint = all.disjoint;
    for (int j = 0; j < p.rows; ++j)
      for (int n = all.first[std::size_t(j)]; n < all.first[std::size_t(j) + 1]; ++n) {
        EdgeBatch& b = colour.batches.emplace_back();
        for (std::size_t k = 0; k < kBatch; ++k) {
          put_nobody(b, k, j);
          b.give[k] = 1;
        }
        const std::vector<int>& chosen = all.elements[std::size_t(n)];
        for (std::size_t k = 0; k < chosen.size(); ++k) {
          const auto e = std::size_t(chosen[k]);
          if (tearing_) place_[e] = {int(edges_.size()) - 1, j, std::size_t(n), k};
          b.near[k] = offset_of(p, edges.ends[e][0]);
          b.far[k] = offset_of(p, edges.ends[e][1]);
          b.rest[k] = float(edges.rest[e]);
          b.give[k] = float(1 / std::max(stiffness * edges.triangles[e], 1e-12));
        }
        colour.edges += std::int64_t(chosen.size());
      }
    if (tears_by_strain()) colour.midst = AlignedArray<float>(colour.batches.size() * kBatch);
  }
  follow_torn();
}

void MeshSweeps::make_hinges(const std::vector<RestTriangle>& triangles) {
  const Particles& p = parts_.particles;
  triangles_ = &triangles;
  std::vector<Corners> elements;
  for (const RestTriangle& r : triangles) elements.push_back(r.corner);
  for (const Batches& all : coloured_batches(order_, elements)) {
    HingeColour& colour = hinges_.emplace_back();
    colour.first = all.first;
    colour.disjoint = all.disjoint;
    for (int j = 0; j < p.rows; ++j)
      for (int n = all.first[std::size_t(j)]; n < all.first[std::size_t(j) + 1]; ++n) {
        MeshBatch& b = colour.batches.emplace_back();
        const std::vector<int>& chosen = all.elements[std::size_t(n)];
        for (std::size_t k = 0; k < kBatch; ++k) {
          colour.triangles.push_back(k < chosen.size() ? chosen[k] : -1);
          for (std::size_t c = 0; c < kMeshCorners; ++c)
            b.corner[c][k] = offset_of_nobody(p, j, int(k));
          if (k >= chosen.size()) continue;
          const RestTriangle& r = triangles[std::size_t(chosen[k])];
          physics::set_triangle(b, k, r);
          for (std::size_t c = 0; c < kMeshCorners; ++c)
            if (r.corner[c] >= 0) b.corner[c][k] = offset_of(p, r.corner[c]);
        }
        colour.count += std::int64_t(chosen.size());
      }
  }
}

void MeshSweeps::append_seams(StageList& list) {
  if (auto seams = make_seam_sweep(parts_, seams_, records_))
    list.stages.push_back(std::move(seams));
}

std::vector<const float*> MeshSweeps::append_edges(ColourSweeps sweeps, History* history,
                                                   StageList& list) {
  list.stages.push_back(make_load_records(parts_, records_, 1));
  const int last = int(edges_.size()) - 1;
  for (int n = 0; n < sweeps.count; ++n) {
    for (int k = 0; k <= last; ++k) {
      const int c = sweeps.backwards(n) ? last - k : k;
      EdgeColour& colour = edges_[std::size_t(c)];
      if (sweeps.count > 1 && colour.lambda.size() == 0)
        colour.lambda = AlignedArray<float>(colour.batches.size() * kBatch);
      list.stages.push_back(std::make_unique<SweepEdges>(
          parts_, colour, records_, EdgeOptions{c, n == 0, 0, n + 1 == sweeps.count}));
    }
    append_seams(list);
  }
  list.stages.push_back(make_store_records(parts_, records_, false, history));
  std::vector<const float*> midst;
  for (const EdgePlace& at : place_)
    if (const AlignedArray<float>& all = edges_[std::size_t(at.colour)].midst; all.size() > 0)
      midst.push_back(all.data() + at.batch * kBatch + at.lane);
  return midst;
}

void MeshSweeps::make_strains(const std::vector<RestTriangle>& triangles, bool keeps_stress) {
  strains_ = std::make_unique<StrainSweeps>(parts_, order_, triangles, records_, keeps_stress,
                                            tearing_ != nullptr);
  if (tears_by_strain()) strains_->tell_lengths();
  follow_torn();
}

void MeshSweeps::append_strains(ColourSweeps sweeps, bool fresh, History* history,
                                StageList& list) {
  list.stages.push_back(make_load_records(parts_, records_, 1));
  for (int n = 0; n < sweeps.count && strains_->damps_before(); ++n)
    strains_->append(sweeps.count, {n == 0, false, true}, list);
  for (int n = 0; n < sweeps.count; ++n) {
    strains_->append(sweeps.count,
                     {fresh && n == 0, n + 1 == sweeps.count, false, sweeps.backwards(n)}, list);
    append_seams(list);
  }
  list.stages.push_back(make_store_records(parts_, records_, false, history));
}

void MeshSweeps::append_hinges(History* history, StageList& list) {
  list.stages.push_back(make_load_records(parts_, records_, 2));
  for (int c = 0; c < int(hinges_.size()); ++c)
    list.stages.push_back(std::make_unique<SweepHinges>(parts_, hinges_[std::size_t(c)],
                                                        *triangles_, records_, c, tearing_));
  append_seams(list);
  list.stages.push_back(make_store_records(parts_, records_, false, history));
}

void MeshSweeps::append_limit(double strain, StageList& list) {
  list.stages.push_back(make_load_records(parts_, records_, 1));
  for (int c = 0; c < int(edges_.size()); ++c)
    list.stages.push_back(std::make_unique<SweepEdges>(parts_, edges_[std::size_t(c)], records_,
                                                       EdgeOptions{c, true, 1 + strain, false}));
  append_seams(list);
  list.stages.push_back(make_store_records(parts_, records_, true, nullptr));
}

std::size_t MeshSweeps::bytes() const {
  std::size_t bytes = records_.size() * sizeof(float) + (strains_ ? strains_->bytes() : 0);
  for (const EdgeColour& c : edges_)
    bytes +=
        c.batches.size() * sizeof(EdgeBatch) + (c.lambda.size() + c.midst.size()) * sizeof(float);
  for (const HingeColour& c : hinges_)
    bytes += c.batches.size() * (sizeof(MeshBatch) + kBatch * sizeof(int));
  return bytes;
}

}  // namespace weft::physics
