// The kernels: everything that runs once per row of particles, built for each instruction set from one source
// (kernels.cmake) and chosen at run time. A kernel takes one plain struct of pointers and constants; it neither
// allocates nor knows which cloth it works on. Each room has a table of its own (kernel_list.h).
#pragma once

#include "weft/simd.h"

namespace weft::physics {

struct ParticleKernels;  // kernels/particles.h
struct LatticeKernels;   // kernels/lattice.h
struct LineKernels;      // kernels/line.h
struct MeshKernels;      // kernels/mesh.h
struct SheetKernels;     // kernels/contact.h
struct BodyKernels;      // kernels/body.h
struct ColliderKernels;  // kernels/colliders.h

struct KernelTable {
  const ParticleKernels& particles;
  const LatticeKernels& lattice;
  const LineKernels& lines;
  const MeshKernels& mesh;
  const SheetKernels& sheets;
  const BodyKernels& bodies;
  const ColliderKernels* const* colliders;  // of every shape, in the order of weft::Shape
};

// The kernels built for one instruction set; of one that is not built it aborts.
const KernelTable& kernel_table(Simd simd);
// What `best` stands for in this build, on this machine; any other stands for itself.
Simd resolved(Simd simd);

}  // namespace weft::physics
