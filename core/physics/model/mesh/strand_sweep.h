// Line sweeps over a mesh: strands in the place of lines.
#pragma once

#include "physics/model/mesh/mesh_tearing.h"
#include "physics/model/mesh/strand_membrane.h"
#include "physics/model/mesh/strands.h"

namespace weft::physics {

// What is made once for the strands of one mesh; stages share it.
class StrandSweeps {
 public:
  // Of springs. `stiffness`: of an edge from each of its triangles [N/m]; `tearing`: null where it cannot; `history`:
  // of the second order, else null.
  StrandSweeps(const ClothParts& parts, const MeshEdges& edges, double stiffness,
               const std::vector<Strand>& strands, MeshTearing* tearing, History* history);
  // Of a membrane that cannot tear.
  StrandSweeps(const ClothParts& parts, const MeshEdges& edges,
               std::unique_ptr<StrandMembrane> membrane, const std::vector<Strand>& strands,
               History* history);

  // So many sweeps one after the other; `fresh`: with the first of a substep.
  std::unique_ptr<Stage> stage(int iterations, bool fresh);
  // Where the last sweep of a stage tells squared lengths, of each edge; none: nothing tears by strain.
  std::vector<const float*> midst() const;

 private:
  class Solver;
  class Sweep;
  std::shared_ptr<Solver> solver_;
};

}  // namespace weft::physics
