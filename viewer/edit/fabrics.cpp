// What make_of() changes, as changes of the document.
#include "edit/fabrics.h"

namespace weft::viewer {

std::vector<Document::Change> changes_to(const Fabric& fabric, const ClothColor& color,
                                         const Scene& scene) {
  Scene made = scene;
  for (Cloth& cloth : made.cloths) {
    make_of(fabric, scene.solver.method, cloth);
    cloth.color = color;
  }
  return changes_between(scene, made);
}

}  // namespace weft::viewer
