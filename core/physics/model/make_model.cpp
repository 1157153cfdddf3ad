// Which model a cloth has (cloth_model.h).
#include "physics/model/lattice/lattice_model.h"
#include "physics/model/mesh/mesh_model.h"

namespace weft::physics {

std::unique_ptr<ClothModel> make_model(const Scene& scene, int index, Method method,
                                       std::uint64_t seed, const KernelTable& kernels) {
  if (scene.cloths[std::size_t(index)].mesh.given())
    return std::make_unique<MeshModel>(scene, index, method, seed, kernels);
  return std::make_unique<LatticeModel>(scene, index, method, seed, kernels);
}

}  // namespace weft::physics
