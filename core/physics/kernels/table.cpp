// The table of this instruction set's kernels.
#include "physics/kernels/row_kernels.h"

namespace weft::WEFT_KERNELS {

// Made when first asked for: before main() it would run instructions that the machine may lack.
const physics::KernelTable& table();
const physics::KernelTable& table() {
  static const physics::KernelTable table = {
      spring_rows,
      spring_stencil,
      damped_spring_stencil,
      tear,
      integrate,
      predict,
      velocity,
      project,
      jacobi_rows,
      jacobi_stencil,
      apply_corrections,
      line_batch,
      rows_to_lanes,
      lanes_to_rows,
      predict_second_order,
      velocity_second_order,
      tethers,
      bend_row,
      bend_line,
      bend_twist,
      {{kSphere.collide[0], kSphere.collide[1]},
       {kPlane.collide[0], kPlane.collide[1]},
       {kCapsule.collide[0], kCapsule.collide[1]},
       {kBox.collide[0], kBox.collide[1]}},
      {kSphere.below_faces, kPlane.below_faces, kCapsule.below_faces, kBox.below_faces},
      wind,
      push,
      block_bounds,
      block_edges,
      near_boxes,
      cell_keys,
      near_pairs,
      beside_pairs,
      close_pairs,
      ask_pairs,
      sum_asked,
      move_bodies,
      gather_bodies,
      scatter_bodies,
      squares_within,
      surface_pairs,
      greatest,
      energy_sum,
      greatest_square,
      stretch_energy,
      tangent,
  };
  return table;
}

}  // namespace weft::WEFT_KERNELS
