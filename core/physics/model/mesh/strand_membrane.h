// What strands know of a mesh's membrane. The multipliers of its triangles are stresses (strain_sweep.h); an edge
// that pulls is such stress of the triangles beside it, along the edge alone. A strand looks for what its edges have
// to add for the strains along them to fit the stress: with T the strains' share in q = (|e|² - l²)/2 and h the
// share of either triangle,
//
//   q + Σ h T·C⁻¹ s = 0,   s <- s + h T μ/(dt² area),   α̃ = Σ h² T·C⁻¹ T/(dt² area)
//
// which leaves nothing to be added where the triangles are solved: both are sweeps over one system.
#pragma once

#include "physics/model/mesh/mesh_edges.h"
#include "physics/model/mesh/strain_sweep.h"

namespace weft::physics {

class StrandMembrane {
 public:
  // Triangles' sweeps outlive it.
  StrandMembrane(const ClothParts& parts, const std::vector<RestTriangle>& triangles,
                 const MeshEdges& edges, StrainSweeps& strains);

  // α̃ dt² of an edge [m³/N].
  double give(int edge) const { return edges_[std::size_t(edge)].give; }
  double rate(double dt) const { return parts_.cloth.membrane.damping / dt; }
  // Of a substep.
  void begin() { strains_.clear_stress(); }
  // What the squared length of an edge is to be [m²], and what has been found of it. Edges of no common triangle
  // may be asked for and told of at once.
  float square(int edge, float rate) const;
  void add(int edge, float multiplier, float inverse_dt2);
  std::size_t bytes() const { return edges_.size() * sizeof(Edge); }

 private:
  struct Side {
    float* held = nullptr;  // the triangle's stress, components kBatch apart; null: no triangle
    float give[3];          // h C⁻¹ T [m³/N]
    float stress[3];        // h T/area
  };
  struct Edge {
    Side sides[2];
    Joined ends;   // where they lie in the component arrays
    float square;  // m²; at rest
    float give;    // m³/N
  };

  const ClothParts& parts_;
  StrainSweeps& strains_;
  std::vector<Edge> edges_;
};

}  // namespace weft::physics
