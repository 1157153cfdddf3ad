// validate(): the ranges come from the schema, by way of the scene's document; what must fit
// together is checked here.
#include "scene/validate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

#include "scene/document.h"
#include "scene/fields.h"
#include "scene/material.h"
#include "scene/mesh/animation.h"
#include "scene/mesh/closed.h"
#include "scene/mesh/faces.h"
#include "scene/mesh/mesh_file.h"
#include "scene/mesh/refused.h"
#include "scene/mesh/seams.h"
#include "scene/pins.h"
#include "weft/mesh.h"
#include "weft/vec3.h"

namespace weft {
namespace text {
namespace {

constexpr std::int64_t kMaxParticles = std::int64_t{1} << 24;  // of all cloths together
constexpr double kMinSpacing = 1e-6;  // m; float positions resolve no finer grid
constexpr double kMaxThickness = 4;   // spacings; a particle has some 50 neighbours within it
constexpr double kMinSine = 1e-3;     // between u and v
constexpr double kMinOffset = 1e-4;   // m, off a mesh that is open
constexpr double kMinReach = 0.01;  // spacings; a cutter that reaches less passes between particles

class Together {
 public:
  Together(const Scene& scene, Check& result) : scene_(scene), result_(result) {}

  void run() {
    solver();
    if (sound({"/gravity"})) check_keys(scene_.gravity_keys, "/gravity/keys", result_);
    if (sound({"/wind/velocity"}))
      check_keys(scene_.wind.velocity_keys, "/wind/velocity/keys", result_);
    std::int64_t particles = 0;
    for (std::size_t c = 0; c < scene_.cloths.size() && !result_.full(); ++c) {
      const Cloth& one = scene_.cloths[c];
      const std::string place = "/cloths/" + std::to_string(c);
      if (sound({place + "/grid"})) particles += std::int64_t{particle_count(one)};
      cloth(one, place);
    }
    if (particles > kMaxParticles)
      fault("/cloths", "the cloths have " + std::to_string(particles) + " particles",
            "4 to 16777216 in all");
    for (std::size_t c = 0; c < scene_.colliders.size() && !result_.full(); ++c)
      collider(scene_.colliders[c], "/colliders/" + std::to_string(c));
  }

 private:
  bool sound(std::initializer_list<std::string> places) const {
    return std::all_of(places.begin(), places.end(),
                       [&](const std::string& place) { return result_.sound(place); });
  }

  void fault(const std::string& place, std::string what, std::string allowed) {
    result_.fault(place, std::move(what), std::move(allowed));
  }

  void solver() {
    const Solver& solver = scene_.solver;
    if (!sound({"/solver/method"})) return;
    const std::string method = words(Method{})[static_cast<std::size_t>(solver.method)];
    const bool projects = solver.method == Method::positional || solver.method == Method::compliant;
    const std::string sweeping = "method positional or compliant; the method is " + method;
    if (solver.sweep != Sweep::gauss_seidel && !projects && sound({"/solver/sweep"}))
      fault("/solver/sweep",
            std::string("sweep is ") + words(Sweep{})[static_cast<std::size_t>(solver.sweep)],
            "only with " + sweeping);
    if (solver.tethers && !projects && sound({"/solver/tethers"}))
      fault("/solver/tethers", "tethers are on", "only with " + sweeping);
    if (solver.order == 2 && solver.method != Method::compliant && sound({"/solver/order"}))
      fault("/solver/order", "order is 2", "only with method compliant; the method is " + method);
    // Relaxed corrections lag behind what the extrapolation from two substeps expects of them.
    else if (solver.order == 2 && solver.sweep == Sweep::jacobi && sound({"/solver/order"}))
      fault("/solver/order", "order is 2",
            "only with sweep gauss_seidel or line; the sweep is jacobi");
  }

  void cloth(const Cloth& cloth, const std::string& place) {
    const std::string its_mesh = place + "/mesh";
    if (!cloth.mesh.given() && cloth.mesh != ClothMesh{} && sound({its_mesh}))
      fault(its_mesh + "/file", kNoMeshFile, kMeshFiles);
    if (cloth.mesh.given())
      mesh(cloth, place);
    else if (sound({its_mesh}))  // else nobody knows what is meant
      sheet(cloth, place);
    check_material(scene_, cloth, place, result_);
    const bool timed = sound({"/time", place + "/drag"}) && scene_.time.substeps > 0;
    const double loss = cloth.drag * scene_.time.frame / std::max(scene_.time.substeps, 1);
    if (timed && loss > 1 + 1e-9)
      fault(place + "/drag", "drag takes " + number_words(loss) + " of the velocity in one substep",
            "0 to 1: less drag or more substeps");
  }

  void mesh(const Cloth& cloth, const std::string& place) {
    if (!sound({place})) return;
    if (cloth.mesh.shape)
      if (const auto wrong = fault_of(cloth.mesh, place + "/mesh"))
        return fault(wrong->place, wrong->what, wrong->allowed);
    if (cloth.mesh.shape)
      if (const auto wrong = fault_of_rest(cloth.mesh, place + "/mesh"))
        return fault(wrong->place, wrong->what, wrong->allowed);
    check_mesh(scene_, cloth, place, result_);
    check_seams(cloth, place, result_);
    check_pressure(cloth, place, result_);
    if (cloth.mesh.shape)
      self_collision(cloth, place, mean_edge(cloth.mesh), "mean edge of the mesh");
    check_pins(scene_, cloth, place + "/pins", result_);
  }

  void sheet(const Cloth& cloth, const std::string& place) {
    check_seams(cloth, place, result_);
    check_pressure(cloth, place, result_);
    if (sound({place + "/grid"}) && grid(cloth.grid, place + "/grid")) {
      masses(cloth, place);
      self_collision(cloth, place, std::min(spacing_u(cloth.grid), spacing_v(cloth.grid)),
                     "spacing of the grid");
      level(cloth, place + "/level");
    }
    if (sound({place + "/grid"})) check_pins(scene_, cloth, place + "/pins", result_);
  }

  bool grid(const Grid& grid, const std::string& place) {
    const std::size_t before = result_.faults.size();
    const auto side = [&](const char* key, const Vec3& vector, double spacing) {
      if (hypot(vector) == 0)
        fault(place + "/" + key, std::string(key) + " is zero", "a side with a length");
      else if (spacing < kMinSpacing)
        fault(place + "/" + key,
              "the particles are " + number_words(spacing) + " m apart along " + key,
              "at least 1e-6 m");
    };
    side("u", grid.u, spacing_u(grid));
    side("v", grid.v, spacing_v(grid));
    if (result_.faults.size() > before) return false;
    if (hypot(cross(grid.u, grid.v)) < kMinSine * hypot(grid.u) * hypot(grid.v)) {
      fault(place, "u and v are parallel", "two directions");
      return false;
    }
    return true;
  }

  void masses(const Cloth& cloth, const std::string& place) {
    const auto expected =
        static_cast<std::size_t>(cloth.grid.nx) * static_cast<std::size_t>(cloth.grid.ny);
    if (!cloth.masses.empty()) {
      if (cloth.masses.size() != expected && sound({place + "/masses"}))
        fault(place + "/masses", "masses has " + std::to_string(cloth.masses.size()) + " values",
              std::to_string(expected) + ", one for each particle, or none");
      return;
    }
    if (!sound({place + "/density", place + "/particle_mass", place + "/masses"})) return;
    const bool given = cloth.particle_mass > 0;
    const Json& one =
        scene_schema_json()["properties"]["cloths"]["items"]["properties"]["masses"]["items"];
    const double most = particle_mass(cloth, cloth.grid.nx / 2, cloth.grid.ny / 2);
    const double least = particle_mass(cloth, 0, 0);  // in a corner
    const bool light = least < one["minimum"].get<double>();
    if (light || most > one["maximum"].get<double>())
      fault(place + (given ? "/particle_mass" : "/density"),
            (least == most ? "each particle"
             : light       ? "a particle in a corner"
                           : "a particle") +
                std::string(" weighs ") + number_words(light ? least : most) + " kg",
            range_words(one));
  }

  // `spacing`: of the particles [m], called so in messages.
  void self_collision(const Cloth& cloth, const std::string& place, double spacing,
                      const char* called) {
    const SelfCollision& self = cloth.self_collision;
    const std::string key = place + "/self_collision/thickness";
    if (self.mode == SelfCollisionMode::off || !sound({place + "/self_collision"})) return;
    const double most = kMaxThickness * spacing;
    if (self.thickness > most)
      fault(key, "thickness is " + number_words(self.thickness),
            number_words(std::min(least_thickness(), most)) + " to " + number_words(most) +
                " m, 4 times the " + called);
  }

  static double least_thickness() {
    const Json& cloth = scene_schema_json()["properties"]["cloths"]["items"]["properties"];
    return cloth["self_collision"]["properties"]["thickness"]["minimum"].get<double>();
  }

  void level(const Cloth& cloth, const std::string& place) {
    const int most = std::max(cloth.grid.nx, cloth.grid.ny) - 1;
    if (sound({place}) && cloth.level > most)
      fault(place, "level is " + std::to_string(cloth.level),
            "0 to " + std::to_string(most) + " on this grid");
  }

  void collider(const Collider& collider, const std::string& place) {
    const Friction& friction = collider.friction;
    if (sound({place + "/friction"}) && friction.model == FrictionModel::coulomb &&
        friction.dynamic > friction.statik)
      fault(place + "/friction",
            "dynamic friction " + number_words(friction.dynamic) + " is above static friction " +
                number_words(friction.statik),
            "0 to " + number_words(friction.statik) + ", at most static");
    if (sound({place + "/friction"}) && (friction.damping > 0) != (friction.bias > 0))
      fault(place + "/friction",
            "damping is " + number_words(friction.damping) + " and bias " +
                number_words(friction.bias),
            "both above 0, or neither");
    if (sound({place + "/keys"})) check_keys(collider.keys, place + "/keys", result_);
    if (sound({place + "/rotate"})) check_rotation(collider.rotate, place + "/rotate", result_);
    const std::string shape = place + "/" + kShapeNames[collider.shape.index()];
    std::visit([&](const auto& one) { this->shape(one, shape); }, collider.shape);
    if (sound({place + "/animation"})) check_animation(collider, place + "/animation", result_);
    if (sound({place + "/offset"})) offset(collider, place);
    if (collider.cuts && sound({place})) cutter(collider, place);
  }

  void cutter(const Collider& collider, const std::string& place) {
    double spacing = std::numeric_limits<double>::infinity();
    for (std::size_t c = 0; c < scene_.cloths.size(); ++c) {
      if (!sound({"/cloths/" + std::to_string(c) + "/grid"})) return;
      const ClothMesh& mesh = scene_.cloths[c].mesh;
      if (mesh.given()) {
        if (!mesh.shape) return;  // not read yet
        spacing = std::min(spacing, mean_edge(mesh));
        continue;
      }
      const Grid& grid = scene_.cloths[c].grid;
      spacing = std::min({spacing, spacing_u(grid), spacing_v(grid)});
    }
    const double reach =
        std::visit([](const auto& shape) { return shape.half_thickness(); }, collider.shape) +
        collider.offset;
    if (reach < kMinReach * spacing)
      fault(place + "/cuts", "the cutter reaches " + number_words(reach) + " m",
            "at least " + number_words(kMinReach * spacing) +
                " m by its size and offset, a hundredth of the spacing of the grid, or of the mean "
                "edge of the mesh");
  }

  // By what its values are to the shape.
  template <class Shape>
  void shape(const Shape& shape, const std::string& place) {
    if (!sound({place})) return;
    std::string first;  // the key of its place, which comes before other points
    Vec3 from{};
    Shape::values(shape, [&](const char* key, const auto& value, ShapeValue is) {
      const std::string at = place + "/" + key;
      if constexpr (std::is_same_v<decltype(value), const Vec3&>) {
        if (is == ShapeValue::place) first = key, from = value;
        const Vec3 axis{value[0] - from[0], value[1] - from[1], value[2] - from[2]};
        if (is == ShapeValue::point && hypot(axis) < kMinSpacing)
          fault(at, key + (" is where " + first) + " is", "at least 1e-6 m from " + first);
        if (is == ShapeValue::direction && hypot(value) < kMinSpacing)
          fault(at, std::string(key) + " is zero", "a direction at least 1e-6 long");
      } else if (is == ShapeValue::rounding && value > shape.half_thickness()) {
        fault(at, std::string(key) + " is " + number_words(value),
              "0 to " + number_words(shape.half_thickness()) + " m, half of the least thickness");
      }
    });
  }

  void shape(const MeshBody& body, const std::string& place) {
    if (!sound({place})) return;
    if (!body.given()) return fault(place + "/file", kNoMeshFile, kMeshFiles);
    if (!body.shape) return;
    if (const auto wrong = fault_of(body, place)) fault(wrong->place, wrong->what, wrong->allowed);
  }

  // What is without an inside would let through what lies on it.
  void offset(const Collider& collider, const std::string& place) {
    const MeshBody* body = std::get_if<MeshBody>(&collider.shape);
    if (!body || !body->surface || collider.offset >= kMinOffset) return;
    const auto open = open_edges(*body->surface);
    if (open.empty()) return;
    fault(place + "/offset",
          "offset is " + number_words(collider.offset) + ", and the mesh is open: " +
              std::to_string(open.size()) + " edges have one triangle, the first from vertex " +
              std::to_string(open[0][0] + 1) + " to " + std::to_string(open[0][1] + 1),
          "1e-4 to 1 m off a surface without an inside, or a closed mesh");
  }

  const Scene& scene_;
  Check& result_;
};

}  // namespace

void check_together(const Scene& scene, Check& result) {
  if (!result.full()) Together(scene, result).run();
}

}  // namespace text

std::vector<Fault> validate(const Scene& scene) {
  text::Check result;
  text::Json document = text::document_of(scene);
  text::check(text::scene_schema_json(), document, result);
  text::release(document);
  text::check_together(scene, result);
  for_each_mesh(scene, [&](const auto& mesh, const std::string& place) {
    bool read = mesh.shape != nullptr;
    if constexpr (std::is_same_v<decltype(mesh), const MeshBody&>)
      read = read &&
             (mesh.surface || text::fault_of(mesh, place) || text::fault_of_motion(mesh, place));
    if (!read && mesh.given())
      result.fault(place_of_file(place), "the mesh is not read", "a mesh whose file has been read");
  });
  return std::move(result.faults);
}

}  // namespace weft
