// The membrane of a mesh as compliant constraints: Green's strains of its triangles (kernels/mesh_strains.cpp),
// by colours, one row stage a colour, on the records of mesh_sweeps.h.
#pragma once

#include "physics/kernels/mesh_sweep.h"
#include "physics/model/mesh/batches.h"
#include "physics/model/mesh/mesh_tearing.h"

namespace weft::physics {

struct StrainColour {
  std::vector<StrainBatch> batches;
  std::vector<int> first;  // batch of each row, and how many there are
  bool disjoint = false;   // its triangles share no vertex
  std::int64_t triangles = 0;
  AlignedArray<float> stress;  // multipliers; none: a single sweep
  AlignedArray<float> midst;   // m², of each side (mesh_sweep.h); none: nobody asks
};

// What a sweep is among others: the first of a substep, and of stress; the last of one, which tells lengths; or of
// damping alone, before the others. `backwards`: through the colours from the last to the first.
struct StrainPass {
  bool fresh, last, damps = false, backwards = false;
};

class StrainSweeps {
 public:
  // `keeps_stress`: multipliers are there whatever the number of sweeps, and may be asked for and changed; damping is
  // then in the sweeps.
  // `tears`: follow() is going to be called. `triangles` outlive it.
  StrainSweeps(const ClothParts& parts, const MeshOrder& order,
               const std::vector<RestTriangle>& triangles, AlignedArray<float>& records,
               bool keeps_stress, bool tears);

  // Before anything is moved: keeps what damping compares with, if there is any.
  void append_places_before(StageList& list);
  // One sweep of so many.
  void append(int iterations, StrainPass pass, StageList& list);
  // Whether sweeps of damping go before them.
  bool damps_before() const { return damped() && !damps_in_one_; }

  // A triangle has lost its membrane, or has it again: as its area says.
  void follow(int triangle);
  void clear_stress();
  // Last sweeps tell squared lengths of sides; where, of each triangle, kBatch apart; none: they do not. Needs tears.
  void tell_lengths();
  std::vector<const float*> midst() const;
  // Of a triangle; its components are kBatch apart [N/m].
  float* stress(int triangle) {
    const Place& at = places_[std::size_t(triangle)];
    return colours_[at.colour].stress.data() + at.first;
  }
  // Of a lane of the component arrays, where something is damped [m].
  Vec3 place_before(int lane) const {
    const float* const at = before_.data() + std::ptrdiff_t(kRecord) * lane;
    return {at[0], at[1], at[2]};
  }
  std::size_t bytes() const;

 private:
  // Of a triangle in the multipliers; the row of its batch.
  struct Place {
    std::size_t colour, first;
    int row;
  };
  static void make_room(StrainColour& colour);
  bool damped() const { return parts_.cloth.membrane.damping > 0; }

  const ClothParts& parts_;
  const std::vector<RestTriangle>& triangles_;
  AlignedArray<float>& records_;
  bool damps_in_one_;
  AlignedArray<float> before_;  // none: nothing is damped
  std::vector<StrainColour> colours_;
  std::vector<Place> places_;  // none: neither stress nor tears are asked for
};

}  // namespace weft::physics
