// The animation of a glTF document as samples of its vertices.
#pragma once

#include <string>
#include <vector>

#include "scene/mesh/gltf_figure.h"
#include "weft/point_cache.h"

namespace weft::text {

struct GltfMotion {
  PointCache cache;
  std::vector<std::string> notes;
};

// Of the first animation of the document: where the vertices of the figures are, one figure after the other, with
// targets that are read. `at_rest`: the pose where no channel says another. Refused besides what is broken: no
// animation, samples at the keys alone of more than 1 GiB.
GltfMotion motion_of(const GltfValue& document, GltfData& data, const GltfNodes& nodes,
                     const std::vector<GltfFigure>& figures, const GltfPose& at_rest);

}  // namespace weft::text
