// The tables of this instruction set's kernels.
#include "physics/kernels/body.h"
#include "physics/kernels/contact.h"
#include "physics/kernels/kernels.h"
#include "physics/kernels/lattice.h"
#include "physics/kernels/line.h"
#include "physics/kernels/mesh.h"
#include "physics/kernels/shape_kernels.h"

namespace weft::WEFT_KERNELS {

using namespace physics;

#define WEFT_DECLARE(returns, name, arguments) returns name arguments;
WEFT_PARTICLE_KERNELS(WEFT_DECLARE)
WEFT_LATTICE_KERNELS(WEFT_DECLARE)
WEFT_LINE_KERNELS(WEFT_DECLARE)
WEFT_MESH_KERNELS(WEFT_DECLARE)
WEFT_SHEET_KERNELS(WEFT_DECLARE)
WEFT_BODY_KERNELS(WEFT_DECLARE)
#undef WEFT_DECLARE
extern const ContactKernels<2> kContactsOfTwo;
extern const ContactKernels<4> kContactsOfFour;

// Made when first asked for: before main() it would run instructions that the machine may lack.
const KernelTable& table();
const KernelTable& table() {
#define WEFT_FILL(returns, name, arguments) .name = name,
#define WEFT_SHAPE_KERNELS(Type, name) &k##Type,
  static const ParticleKernels particles = {WEFT_PARTICLE_KERNELS(WEFT_FILL)};
  static const LatticeKernels lattice = {WEFT_LATTICE_KERNELS(WEFT_FILL)};
  static const LineKernels lines = {WEFT_LINE_KERNELS(WEFT_FILL)};
  static const MeshKernels mesh = {WEFT_MESH_KERNELS(WEFT_FILL)};
  static const SheetKernels sheets = {WEFT_SHEET_KERNELS(WEFT_FILL)  //
                                          .contacts_of_two = kContactsOfTwo,
                                      .contacts_of_four = kContactsOfFour};
  static const BodyKernels bodies = {WEFT_BODY_KERNELS(WEFT_FILL)};
  static const ColliderKernels* const colliders[] = {WEFT_SHAPES(WEFT_SHAPE_KERNELS)};
  static const KernelTable all = {particles, lattice, lines, mesh, sheets, bodies, colliders};
  return all;
#undef WEFT_SHAPE_KERNELS
#undef WEFT_FILL
}

}  // namespace weft::WEFT_KERNELS
