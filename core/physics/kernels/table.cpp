// The table of this instruction set's kernels.
#include "physics/kernels/row_kernels.h"

namespace weft::WEFT_KERNELS {

#define WEFT_KERNELS_OF_SHAPE(Type, name) &k##Type,

// Made when first asked for: before main() it would run instructions that the machine may lack.
const physics::KernelTable& table();
const physics::KernelTable& table() {
  static const physics::KernelTable table = {
      .spring_rows = spring_rows,
      .membrane_rows = membrane_rows,
      .spring_stencil = spring_stencil,
      .damped_spring_stencil = damped_spring_stencil,
      .tear = tear,
      .tear_edges = tear_edges,
      .integrate = integrate,
      .predict = predict,
      .velocity = velocity,
      .project = project,
      .jacobi_rows = jacobi_rows,
      .jacobi_stencil = jacobi_stencil,
      .apply_corrections = apply_corrections,
      .line_batch = line_batch,
      .membrane_line_batch = membrane_line_batch,
      .membrane_squares = membrane_squares,
      .rows_to_lanes = rows_to_lanes,
      .lanes_to_rows = lanes_to_rows,
      .predict_second_order = predict_second_order,
      .velocity_second_order = velocity_second_order,
      .tethers = tethers,
      .bend_row = bend_row,
      .bend_line = bend_line,
      .bend_twist = bend_twist,
      .collider = {WEFT_SHAPES(WEFT_KERNELS_OF_SHAPE)},
      .wind = wind,
      .mesh_wind = mesh_wind,
      .push = push,
      .block_bounds = block_bounds,
      .block_edges = block_edges,
      .near_boxes = near_boxes,
      .cell_keys = cell_keys,
      .near_pairs = near_pairs,
      .beside_pairs = beside_pairs,
      .gather_bodies = gather_bodies,
      .meeting_pairs = meeting_pairs,
      .squares_within = squares_within,
      .squares_not_apart = squares_not_apart,
      .surface_pairs = surface_pairs,
      .contacts_of_two = kContactsOfTwo,
      .contacts_of_four = kContactsOfFour,
      .greatest = greatest,
      .energy_sum = energy_sum,
      .greatest_square = greatest_square,
      .stretch_energy = stretch_energy,
      .tangent = tangent,
      .mesh_load = mesh_load,
      .mesh_forces = mesh_forces,
      .mesh_move = mesh_move,
      .load_records = load_records,
      .store_records = store_records,
      .sweep_edges = sweep_edges,
      .sweep_hinges = sweep_hinges,
      .sweep_strains = sweep_strains,
  };
  return table;
}

#undef WEFT_KERNELS_OF_SHAPE

}  // namespace weft::WEFT_KERNELS
