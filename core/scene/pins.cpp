// Which particles pins hold (scene.h), and what can be wrong with them (pins.h).
#include "scene/pins.h"

#include <algorithm>
#include <map>

#include "weft/mesh.h"
#include "weft/vec3.h"

namespace weft {
namespace {

// Where particles start [m]; none of a mesh that is not read.
std::vector<Vec3> starts_of(const Cloth& cloth) {
  if (cloth.mesh.given())
    return cloth.mesh.shape ? placed_vertices(cloth.mesh) : std::vector<Vec3>();
  std::vector<Vec3> starts;
  const Grid& grid = cloth.grid;
  for (int j = 0; j < grid.ny; ++j)
    for (int i = 0; i < grid.nx; ++i) starts.push_back(place_on(grid, i, j));
  return starts;
}

bool within(const BoxCorners& box, const Vec3& at) {
  for (std::size_t k = 0; k < 3; ++k)
    if (at[k] < std::min(box[0][k], box[1][k]) || at[k] > std::max(box[0][k], box[1][k]))
      return false;
  return true;
}

const TriangleMesh::Group* group_of(const Cloth& cloth, const std::string& name) {
  if (!cloth.mesh.shape) return nullptr;
  const auto& groups = cloth.mesh.shape->groups;
  const auto found =
      std::find_if(groups.begin(), groups.end(), [&](const auto& g) { return g.name == name; });
  return found == groups.end() ? nullptr : &*found;
}

// `starts`: of the cloth.
std::vector<int> held_by(const Cloth& cloth, const Pin& pin, const std::vector<Vec3>& starts) {
  std::vector<int> held;
  if (!pin.of_several()) {
    held = {particle_number(cloth, pin)};
  } else if (pin.group) {
    if (const TriangleMesh::Group* group = group_of(cloth, *pin.group)) held = group->vertices;
  } else if (pin.box) {
    for (std::size_t p = 0; p < starts.size(); ++p)
      if (within(*pin.box, starts[p])) held.push_back(int(p));
  } else {
    held = pin.vertices;
    std::sort(held.begin(), held.end());
  }
  return held;
}

}  // namespace

std::vector<int> held_particles(const Cloth& cloth, const Pin& pin) {
  return held_by(cloth, pin, pin.box ? starts_of(cloth) : std::vector<Vec3>());
}

std::vector<Pin> single_pins(const Cloth& cloth) {
  const auto several = [](const Pin& pin) { return pin.of_several(); };
  if (std::none_of(cloth.pins.begin(), cloth.pins.end(), several)) return cloth.pins;
  const std::vector<Vec3> starts = starts_of(cloth);
  const int columns = cloth.mesh.given() ? particle_count(cloth) : cloth.grid.nx;
  std::vector<Pin> single;
  for (const Pin& pin : cloth.pins) {
    if (!several(pin)) {
      single.push_back(pin);
      continue;
    }
    for (const int p : held_by(cloth, pin, starts)) {
      Pin& one = single.emplace_back(
          Pin{p % columns, p / columns, pin.keys, pin.rotate, pin.follow, {}, {}, {}});
      for (Key& key : one.keys)
        for (std::size_t k = 0; k < 3; ++k) key.position[k] += starts[std::size_t(p)][k];
    }
  }
  return single;
}

namespace text {
namespace {

constexpr std::size_t kMaxHeldKeys = std::size_t{1} << 22;  // of the particles of pins of several
constexpr std::size_t kMaxSearch = std::size_t{1} << 30;  // particles and groups that are looked at

std::string names_of(const std::vector<TriangleMesh::Group>& groups) {
  constexpr std::size_t kNamed = 20;
  if (groups.empty()) return "the file has none";
  std::string names;
  for (std::size_t n = 0; n < std::min(groups.size(), kNamed); ++n)
    names += (n > 0 ? ", \"" : "\"") + groups[n].name.substr(0, 64) + "\"";
  if (groups.size() > kNamed) names += " and " + std::to_string(groups.size() - kNamed) + " others";
  return names;
}

std::string at(int i, int j) {
  return "[" + std::to_string(i) + ", " + std::to_string(j) + "]";
}

class Pins {
 public:
  Pins(const Scene& scene, const Cloth& cloth, Check& result)
      : scene_(scene), cloth_(cloth), result_(result), count_(particle_count(cloth)) {
    const auto boxes = [](const Pin& pin) { return pin.box.has_value(); };
    if (std::any_of(cloth.pins.begin(), cloth.pins.end(), boxes)) starts_ = starts_of(cloth);
  }

  // Whether what pins name is found in time: every box is held against all particles, every name against all
  // groups.
  bool are_few(const std::string& place) {
    std::size_t search = 0;
    for (const Pin& pin : cloth_.pins) {
      if (pin.box) search += starts_.size();
      if (pin.group && cloth_.mesh.shape) search += cloth_.mesh.shape->groups.size();
    }
    if (search <= kMaxSearch) return true;
    fault(place, "the pins' boxes and groups are " + std::to_string(search) + " to be looked up",
          "at most 1073741824: boxes times particles and names times groups");
    return false;
  }

  void check(const Pin& pin, const std::string& here) {
    if (!result_.sound(here)) return;
    if (is_there(pin, here)) hold(pin, here);
    path(pin, here);
  }

 private:
  bool mesh() const { return cloth_.mesh.given(); }
  // A mesh that is not read has vertices that nobody knows yet.
  bool known() const { return !mesh() || cloth_.mesh.shape; }
  void fault(const std::string& place, std::string what, std::string allowed) {
    result_.fault(place, std::move(what), std::move(allowed));
  }

  bool is_there(const Pin& pin, const std::string& here) {
    if (pin.of_several() && !pin.vertices.empty() + pin.group.has_value() + pin.box.has_value() > 1)
      return fault(here, "the pin has several of vertices, group and box", "one of them"), false;
    if (pin.group) return group(*pin.group, here + "/group");
    if (pin.box) return true;
    if (pin.vertices.empty()) return one(pin, here);
    for (std::size_t n = 0; n < pin.vertices.size(); ++n)
      if (!number(pin.vertices[n], here + "/vertices/" + std::to_string(n))) return false;
    return true;
  }

  bool one(const Pin& pin, const std::string& here) {
    if (mesh() && pin.j == 0) return number(pin.i, here);
    const Grid& grid = cloth_.grid;
    if (mesh())
      fault(here, "the pin " + at(pin.i, pin.j) + " is no vertex of the mesh",
            known() ? "0 to " + std::to_string(count_ - 1) : "a number from 0 on");
    else if (pin.i < 0 || pin.j < 0 || pin.i >= grid.nx || pin.j >= grid.ny)
      fault(here, "the pin " + at(pin.i, pin.j) + " is outside of the grid",
            "[0, 0] to " + at(grid.nx - 1, grid.ny - 1));
    else
      return true;
    return false;
  }

  bool number(int particle, const std::string& here) {
    if (particle >= 0 && (!known() || particle < count_)) return true;
    fault(here,
          "the pin " + std::to_string(particle) + " is no " +
              (mesh() ? "vertex of the mesh" : "particle of the grid"),
          known() ? "0 to " + std::to_string(count_ - 1) : "a number from 0 on");
    return false;
  }

  bool group(const std::string& name, const std::string& here) {
    if (!mesh()) return fault(here, "a grid has no groups", "at, vertices or box"), false;
    if (!known() || group_of(cloth_, name)) return true;
    fault(here, "the mesh has no group \"" + name + "\"", names_of(cloth_.mesh.shape->groups));
    return false;
  }

  // Each particle once, whatever pins name it by.
  void hold(const Pin& pin, const std::string& here) {
    const std::vector<int> held = held_by(cloth_, pin, starts_);
    if (pin.box && held.empty() && known())
      return fault(here + "/box", "no particle starts in the box",
                   "corners of a box, in m, with at least one in it");
    if (pin.of_several()) held_keys_ += held.size() * (pin.keys.size() + pin.rotate.keys.size());
    if (held_keys_ > kMaxHeldKeys)
      return fault(here,
                   "with this pin, pins of several hold particles by " +
                       std::to_string(held_keys_) + " keys, each counted for each particle",
                   "at most 4194304 in all");
    for (const int p : held) {
      const auto [before, fresh] = held_.try_emplace(p, here);
      if (fresh) continue;
      const std::string name = mesh()
                                   ? "the vertex " + std::to_string(p)
                                   : "the particle " + at(p % cloth_.grid.nx, p / cloth_.grid.nx);
      return fault(here, name + " is pinned twice", "once; it is held by " + before->second);
    }
  }

  // How a pin moves.
  void path(const Pin& pin, const std::string& here) {
    check_keys(pin.keys, here + "/keys", result_);
    check_rotation(pin.rotate, here + "/rotate", result_);
    const auto colliders = static_cast<int>(scene_.colliders.size());
    if (pin.follow >= colliders)
      fault(here + "/follow", "there is no collider " + std::to_string(pin.follow),
            colliders == 0 ? "the scene has none" : "0 to " + std::to_string(colliders - 1));
  }

  const Scene& scene_;
  const Cloth& cloth_;
  Check& result_;
  const int count_;
  std::vector<Vec3> starts_;
  std::size_t held_keys_ = 0;
  std::map<int, std::string> held_;  // and by which pin
};

}  // namespace

void check_rotation(const Rotation& rotation, const std::string& place, Check& result) {
  check_keys(rotation.keys, place + "/keys", result);
  if (hypot(rotation.axis) < 1e-6)
    result.fault(place + "/axis", "axis is zero", "a direction at least 1e-6 long");
}

void check_pins(const Scene& scene, const Cloth& cloth, const std::string& place, Check& result) {
  Pins pins(scene, cloth, result);
  if (!pins.are_few(place)) return;
  for (std::size_t k = 0; k < cloth.pins.size() && !result.full(); ++k)
    pins.check(cloth.pins[k], place + "/" + std::to_string(k));
}

}  // namespace text
}  // namespace weft
