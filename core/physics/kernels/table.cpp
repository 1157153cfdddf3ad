// The table of this instruction set's kernels.
#include "physics/kernels/row_kernels.h"

namespace weft::WEFT_KERNELS {

extern const physics::KernelTable kTable;
const physics::KernelTable kTable = {
    spring_rows,    spring_family, damped_spring_family, integrate, predict,
    velocity,       project,       project_jacobi,       apply_corrections,
    sphere,         plane,         course_sphere,        course_plane,
    line_strip,     rows_to_lanes, lanes_to_rows,        predict_second_order,
    velocity_second_order, tethers, bend_row, bend_line,
    bend_twist,
};

}  // namespace weft::WEFT_KERNELS
