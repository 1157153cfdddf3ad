// Sweeps over a mesh's constraints: edges as compliant constraints or as a strain limit, and the bending of
// triangles. All are Gauss–Seidel by colours in a fixed order, one row stage a colour: in the order of rows, forward
// or backward in turn, sweeps of one constraint after another blow up on meshes. Vertices lie in
// records meanwhile (kernels/mesh_sweep.h), where a stage of its own puts them, and from where another takes
// them back.
#pragma once

#include "physics/kernels/mesh_sweep.h"
#include "physics/model/colour_sweeps.h"
#include "physics/model/mesh/batches.h"
#include "physics/model/mesh/mesh_tearing.h"
#include "physics/model/mesh/seams.h"
#include "physics/model/mesh/strain_sweep.h"

namespace weft::physics {

struct EdgeColour {
  std::vector<EdgeBatch> batches;
  std::vector<int> first;  // batch of each row, and how many there are
  bool disjoint = false;   // its edges share no vertex
  std::int64_t edges = 0;
  AlignedArray<float> lambda;  // multipliers; none: a single sweep
  AlignedArray<float> midst;   // m², of each place (mesh_sweep.h); none: nothing tears by strain
};

struct HingeColour {
  std::vector<MeshBatch> batches;
  std::vector<int> triangles;  // of each place in the batches, -1: none
  std::vector<int> first;
  bool disjoint = false;
  std::int64_t count = 0;
};

// What is made once for the sweeps of one mesh.
class MeshSweeps : private TornParts {
 public:
  // `tearing`: null where it cannot.
  MeshSweeps(const ClothParts& parts, const MeshOrder& order, const Seams& seams,
             MeshTearing* tearing);

  // `stiffness`: of an edge from each of its triangles [N/m].
  void make_edges(const MeshEdges& edges, double stiffness);
  void make_hinges(const std::vector<RestTriangle>& triangles);
  void make_strains(const std::vector<RestTriangle>& triangles, bool keeps_stress);

  // `history`: of the second order, else null.
  // Edges as compliant constraints; positions and velocities gain the corrections at the end. Returns where the last
  // tells squared lengths, of each edge; none: nothing tears by strain.
  std::vector<const float*> append_edges(ColourSweeps sweeps, History* history, StageList& list);
  void append_hinges(History* history, StageList& list);
  // The membrane of triangles, likewise; `fresh`: from no stress.
  void append_strains(ColourSweeps sweeps, bool fresh, History* history, StageList& list);
  // Nothing is longer than 1 + strain times its length.
  void append_limit(double strain, StageList& list);

  // Stages are chosen anew: what tears is told of again.
  void follow_tears() {
    if (tearing_) tearing_->tell(*this);
  }
  bool knows_edges() const { return !edges_.empty(); }
  StrainSweeps* strains() { return strains_.get(); }  // null: not made yet
  std::size_t bytes() const;

 private:
  // Of an edge.
  struct EdgePlace {
    int colour = 0, row = 0;
    std::size_t batch = 0, lane = 0;
  };

  bool tears_by_strain() const { return tearing_ && parts_.cloth.tear_strain > 0; }
  void append_seams(StageList& list);
  void put_nobody(EdgeBatch& batch, std::size_t lane, int row) const;
  void set_edge(int edge, bool holds) override;
  void follow_torn();

  const ClothParts& parts_;
  const MeshOrder& order_;
  const Seams& seams_;
  MeshTearing* const tearing_;
  AlignedArray<float> records_;
  std::vector<EdgeColour> edges_;
  std::vector<EdgePlace> place_;  // of every edge, where they can tear
  const std::vector<RestTriangle>* triangles_ = nullptr;
  std::vector<HingeColour> hinges_;
  std::unique_ptr<StrainSweeps> strains_;
};

}  // namespace weft::physics
