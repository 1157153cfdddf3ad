#include "scene/mesh/forms.h"

#include "scene/mesh/mesh_file.h"

namespace weft::text {
namespace {

void check_file(const Json& mesh, const std::string& place, Check& result) {
  const Json* const file = member(mesh, "file");
  if ((!file || *file == "") && result.sound(place + "/file"))
    result.fault(place + "/file", kNoMeshFile, kMeshFiles);
}

void check_rest(const Json& mesh, const std::string& place, Check& result) {
  const Json* const rest = member(mesh, "rest");
  if (rest && *rest == "")
    result.fault(place + "/rest", "rest is empty", "shape, flat or uv, or a second mesh file");
}

void check_pin(const Json& pin, const std::string& place, Check& result) {
  const Json* const at = member(pin, "at");
  const Json& named = at ? *at : pin;
  const std::string here = at ? place + "/at" : place;
  if (named.is_array() && result.sound(here))
    result.fault(here,
                 "the pin " + brief(named) + " is a column and a row, and the cloth is a mesh",
                 "the number of a vertex, from 0 on");
}

}  // namespace

void check_forms(const Json& document, Check& result) {
  const Json* const cloths = member(document, "cloths");
  for (std::size_t c = 0; cloths && cloths->is_array() && c < cloths->size(); ++c) {
    const std::string place = "/cloths/" + std::to_string(c);
    const Json* const mesh = member((*cloths)[c], "mesh");
    if (!mesh || !mesh->is_object()) continue;
    check_file(*mesh, place + "/mesh", result);
    check_rest(*mesh, place + "/mesh", result);
    const Json* const pins = member((*cloths)[c], "pins");
    for (std::size_t k = 0; pins && pins->is_array() && k < pins->size() && !result.full(); ++k)
      check_pin((*pins)[k], place + "/pins/" + std::to_string(k), result);
  }
}

}  // namespace weft::text
