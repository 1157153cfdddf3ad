// Whether what a cloth is made of fits together (material.h).
#include "scene/material.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "scene/json_text.h"

namespace weft::text {
namespace {

class Material {
 public:
  Material(const Scene& scene, const Cloth& one, const std::string& where, Check& found)
      : scene_(scene), cloth_(one), place_(where), result_(found) {}

  void run() {
    const Membrane& membrane = cloth_.membrane;
    if (!sound("/membrane") || !sound("/stiffness")) return;
    if (membrane.given()) membrane_fits();
    if (!membrane.given() && membrane.coupling != 0)
      fault(place_ + "/membrane/coupling", "coupling is given, and warp, weft and shear are 0",
            "0 without moduli");
    if (!membrane.given() && membrane.damping > 0)
      fault(place_ + "/membrane/damping", "damping is given, and warp, weft and shear are 0",
            "0 without moduli");
    const Bending& bending = cloth_.bending;
    if (sound("/bending") && !bending.given() && bending.damping > 0)
      fault(place_ + "/bending/damping", "damping is given, and warp, weft and twist are 0",
            "0 without rigidity");
    else if (sound("/bending") && !cloth_.mesh.given() && !membrane.given() && bending.damping > 0)
      fault(place_ + "/bending/damping", "damping is " + number_words(bending.damping),
            "0 s, on a grid of springs");
  }

 private:
  bool sound(const char* key) const { return result_.sound(place_ + key); }
  void fault(const std::string& at, std::string what, std::string allowed) {
    result_.fault(at, std::move(what), std::move(allowed));
  }

  // The energy of any strain is above 0, and the shear softer than the threads.
  void positive() {
    const Membrane& m = cloth_.membrane;
    const std::string place = place_ + "/membrane";
    const std::pair<const char*, double> moduli[] = {
        {"warp", m.warp}, {"weft", m.weft}, {"shear", m.shear}};
    for (const auto& [name, modulus] : moduli)
      if (!(modulus > 0)) return fault(place + "/" + name, std::string(name) + " is 0", "above 0");
    const double most = std::sqrt(m.warp * m.weft), softer = std::min(m.warp, m.weft);
    if (m.coupling >= most || m.coupling <= -most)
      fault(place + "/coupling", "coupling is " + number_words(m.coupling),
            "between " + number_words(-most) + " and " + number_words(most) +
                " N/m, the root of warp times weft");
    if (m.shear >= softer)
      fault(place + "/shear", "shear is " + number_words(m.shear),
            "below " + number_words(softer) + " N/m, warp or weft");
  }

  // What a membrane cannot go with.
  void membrane_fits() {
    constexpr double kRight = 1e-6;  // cosine of the angle between u and v
    positive();
    const Vec3 &u = cloth_.grid.u, &v = cloth_.grid.v;
    const auto product = [](const Vec3& a, const Vec3& b) {
      return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    };
    if (!cloth_.mesh.given() && sound("/grid") &&
        std::abs(product(u, v)) > kRight * std::sqrt(product(u, u) * product(v, v)))
      fault(place_ + "/membrane", "u and v of the grid are not at right angles",
            "a membrane's warp and weft are");
    if (cloth_.stiffness != Cloth{}.stiffness || cloth_.spring_damping != Kinds{})
      fault(place_ + "/membrane", "both membrane and stiffness or spring_damping are given",
            "one of the two");
    if (result_.sound("/solver/method") && scene_.solver.method == Method::positional)
      fault(place_ + "/membrane", "a membrane is given", "not with method positional");
    if (sound("/level") && cloth_.level > 0)
      fault(place_ + "/membrane", "a membrane is given beside a level", "level 0");
  }

  const Scene& scene_;
  const Cloth& cloth_;
  const std::string& place_;
  Check& result_;
};

}  // namespace

void check_material(const Scene& scene, const Cloth& cloth, const std::string& place,
                    Check& result) {
  Material(scene, cloth, place, result).run();
}

}  // namespace weft::text
