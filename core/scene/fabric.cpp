// The table of fabrics (weft/fabric.h), and the key `fabric` of a scene (scene/fabric.h).
#include "weft/fabric.h"

#include <algorithm>
#include <array>

#include "scene/document.h"
#include "scene/fabric.h"

namespace weft {
namespace {

Bending bending(double warp, double weft, double twist, double damping) {
  Bending b;
  b.warp = warp, b.weft = weft, b.twist = twist, b.damping = damping;
  return b;
}

}  // namespace

std::span<const Fabric> fabrics() {
  static const std::array<Fabric, 5> all{{
      {"silk", 0.08, {400, 300, 20, 12, 1e-5}, bending(1.2e-6, 0.8e-6, 1e-6, 1e-3), 0.25},
      {"cotton", 0.14, {1500, 1000, 100, 35, 1e-5}, bending(1.5e-5, 8e-6, 1.1e-5, 1e-3), 0.4},
      {"wool", 0.25, {1200, 800, 100, 40, 1e-5}, bending(1.8e-5, 1.2e-5, 1.5e-5, 1e-3), 0.45},
      {"denim", 0.40, {2500, 1500, 150, 110, 1e-5}, bending(1e-4, 5e-5, 7e-5, 1e-3), 0.5},
      {"leather", 0.55, {2500, 2500, 750, 850, 1e-5}, bending(3.5e-5, 3.5e-5, 3.5e-5, 1e-3), 0.55},
  }};
  return all;
}

const Fabric* find_fabric(std::string_view name) {
  const std::span<const Fabric> all = fabrics();
  const auto found = std::ranges::find(all, name, &Fabric::name);
  return found == all.end() ? nullptr : &*found;
}

void make_of(const Fabric& fabric, Method method, Cloth& cloth) {
  const Cloth standard;
  cloth.density = fabric.weight;
  cloth.particle_mass = 0;
  cloth.masses.clear();
  cloth.level = 0;
  cloth.stiffness = standard.stiffness;
  cloth.spring_damping = standard.spring_damping;
  cloth.membrane = fabric.membrane;
  cloth.bending = fabric.bending;
  cloth.self_collision.friction = fabric.friction;
  if (method == Method::positional) {
    // Of a square grid of springs kn along the threads and kd across, C11 = kn + kd and C66 = kd.
    const Membrane& m = fabric.membrane;
    cloth.membrane = {};
    if (!cloth.mesh.given()) cloth.bending.damping = 0;  // springs on a grid have none
    cloth.stiffness = {(m.warp + m.weft) / 2 - m.shear, m.shear, 0};
  }
}

namespace text {
namespace {

// Gives an object what it lacks; what it has stays. Returns whether it lacked anything.
bool fill(Json& object, const Json& values) {
  bool lacked = false;
  for (const auto& [key, value] : values.items()) {
    const Json* has = member(object, key);
    if (!has) {
      put(object, key, Json(value));
      lacked = true;
    } else if (has->is_object() && value.is_object()) {
      lacked |= fill(object[key], value);
    }
  }
  return lacked;
}

// The values that stand for the name of a fabric, as a scene has them.
Json values_of(const Fabric& fabric, Method method, const Json& cloth) {
  Scene scene;
  Cloth& made = scene.cloths.emplace_back();
  const Json* const mesh = member(cloth, "mesh");
  const Json* const file = mesh ? member(*mesh, "file") : nullptr;
  if (file && file->is_string()) made.mesh.file = file->get<std::string>();
  make_of(fabric, method, made);
  const bool springs =
      member(cloth, "stiffness") || member(cloth, "spring_damping") || member(cloth, "level");
  if (springs && !made.mesh.given()) made.bending.damping = 0;
  const Json all = std::move(document_of(scene)["cloths"][0]);
  Json values = Json::object();
  values["density"] = all["density"];
  if (method == Method::positional)
    values["stiffness"] =
        made.mesh.given() ? Json{{"structural", made.stiffness.structural}} : all["stiffness"];
  else if (!springs)
    values["membrane"] = all["membrane"];
  values["bending"] = all["bending"];
  values["self_collision"]["friction"] = all["self_collision"]["friction"];
  return values;
}

}  // namespace

void unfold_fabrics(Json& document, Check& result) {
  const Json* const cloths = member(document, "cloths");
  if (!cloths || !cloths->is_array()) return;
  const Json* const solver = member(document, "solver");
  const Json* const method = solver ? member(*solver, "method") : nullptr;
  const bool positional = method && *method == "positional";
  for (std::size_t c = 0; c < cloths->size(); ++c) {
    Json& cloth = document["cloths"][c];
    const Json* const name = member(cloth, "fabric");
    const Fabric* const fabric =
        name && name->is_string() ? find_fabric(name->get_ref<const std::string&>()) : nullptr;
    if (!fabric) continue;  // what is no fabric's name, the schema faults
    if (!fill(cloth, values_of(*fabric, positional ? Method::positional : Method::spring, cloth)))
      result.fault(
          "/cloths/" + std::to_string(c) + "/fabric",
          "the fabric gives nothing: density, membrane or springs, bending and friction are given",
          "one of them left out, or no fabric");
  }
}

}  // namespace text
}  // namespace weft
