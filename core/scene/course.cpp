#include "scene/course.h"

#include <utility>

#include "scene/read_fields.h"

namespace weft::text {
namespace {

// The course's simulator: 90 frames a second of 30 steps, springs never beyond 110 %, planes with a
// surface offset.
constexpr int kFramesPerSecond = 90;
constexpr int kSteps = 30;
constexpr double kGravity = -9.8;  // m/s²
constexpr double kStrainLimit = 0.1;
constexpr double kSurfaceOffset = 1e-4;    // m
constexpr double kVerticalJitter = 0.001;  // m
constexpr double kBendingShare = 0.2;      // of ks

// The values of a course file; docs/course.schema.json describes them.
struct CourseCloth {
  double width = 1, height = 1;
  int num_width_points = 50, num_height_points = 50;
  double thickness = 0.0095;
  int orientation = 0;
  double damping = 0.2;
  double density = 150;
  double ks = 5000;
  bool enable_structural = true, enable_shearing = true, enable_bending = true;
  std::vector<Pin> pinned;
};

struct CourseSphere {
  Vec3 origin{};
  double radius = 0.2;
  double friction = 0.3;
};

struct CoursePlane {
  Vec3 point{};
  Vec3 normal{0, 1, 0};
  double friction = 0.5;
};

void fields(FieldReader& walk, CourseCloth& cloth) {
  walk("width", cloth.width);
  walk("height", cloth.height);
  walk("num_width_points", cloth.num_width_points);
  walk("num_height_points", cloth.num_height_points);
  walk("thickness", cloth.thickness);
  walk("orientation", cloth.orientation);
  walk("damping", cloth.damping);
  walk("density", cloth.density);
  walk("ks", cloth.ks);
  walk("enable_structural", cloth.enable_structural);
  walk("enable_shearing", cloth.enable_shearing);
  walk("enable_bending", cloth.enable_bending);
  walk("pinned", cloth.pinned);
}

void fields(FieldReader& walk, CourseSphere& sphere) {
  walk("origin", sphere.origin);
  walk("radius", sphere.radius);
  walk("friction", sphere.friction);
}

void fields(FieldReader& walk, CoursePlane& plane) {
  walk("point", plane.point);
  walk("normal", plane.normal);
  walk("friction", plane.friction);
}

// The course puts the particles width/num_width_points apart, so the sheet ends one spacing short.
Grid grid_of(const CourseCloth& from) {
  const double width = from.width * (from.num_width_points - 1) / from.num_width_points;
  const double height = from.height * (from.num_height_points - 1) / from.num_height_points;
  const bool horizontal = from.orientation == 0;
  Grid grid;
  grid.nx = from.num_width_points;
  grid.ny = from.num_height_points;
  grid.origin = {0, horizontal ? 1.0 : 0.0, 0};
  grid.u = {width, 0, 0};
  grid.v = horizontal ? Vec3{0, 0, height} : Vec3{0, height, 0};
  grid.jitter = horizontal ? 0 : kVerticalJitter;
  return grid;
}

Cloth cloth_of(const CourseCloth& from) {
  Cloth cloth;
  cloth.grid = grid_of(from);
  cloth.particle_mass =
      from.density * from.width * from.height / from.num_width_points / from.num_height_points;
  cloth.lumping = Lumping::equal;
  cloth.stiffness = {from.enable_structural ? from.ks : 0, from.enable_shearing ? from.ks : 0,
                     from.enable_bending ? kBendingShare * from.ks : 0};
  cloth.drag = from.damping * (kFramesPerSecond * kSteps / 100.0);
  cloth.strain_limit = kStrainLimit;
  cloth.strain_limit_order = StrainLimitOrder::strict;
  cloth.self_collision.mode = SelfCollisionMode::particles;
  cloth.self_collision.thickness = 2 * from.thickness;
  cloth.self_collision.response = SelfCollisionResponse::course;
  cloth.pins = from.pinned;
  return cloth;
}

Collider collider_of(Shape shape, double friction, double offset) {
  Collider collider;
  collider.shape = std::move(shape);
  collider.friction = {FrictionModel::course, friction, friction};
  collider.offset = offset;
  return collider;
}

// Calls visit(document, place in the file) for every body of a kind.
template <class Visit>
void each_body(const CourseFile& file, const std::string& kind, const Visit& visit) {
  if (file.document.contains(kind)) visit(file.document, "/" + kind);
  for (const CourseBody& body : file.more)
    if (body.kind == kind) visit(body.document, body.place);
}

bool starts(const std::string& place, const std::string& prefix) {
  return place.starts_with(prefix) &&
         (place.size() == prefix.size() || place[prefix.size()] == '/');
}

}  // namespace

bool is_course(const Json& document) {
  if (!document.is_object() || document.contains("weft")) return false;
  return document.contains("cloth") || document.contains("sphere") || document.contains("plane");
}

Scene scene_of_course(const CourseFile& file) {
  Scene scene;
  FieldReader walk(file.document);
  walk("name", scene.name);
  walk("about", scene.about);
  scene.gravity = {0, kGravity, 0};
  scene.time.frame = 1.0 / kFramesPerSecond;
  scene.time.substeps = kSteps;
  scene.solver.full_first_kick = true;
  CourseCloth cloth;
  walk("cloth", cloth);
  std::vector<Pin> pins;
  for (const std::size_t k : first_pins(file.document)) pins.push_back(cloth.pinned[k]);
  cloth.pinned = std::move(pins);
  scene.cloths.push_back(cloth_of(cloth));
  each_body(file, "sphere", [&](const Json& document, const std::string&) {
    CourseSphere sphere;
    FieldReader body(document);
    body("sphere", sphere);
    scene.colliders.push_back(
        collider_of(Sphere{sphere.origin, sphere.radius}, sphere.friction, 0));
  });
  each_body(file, "plane", [&](const Json& document, const std::string&) {
    CoursePlane plane;
    FieldReader body(document);
    body("plane", plane);
    scene.colliders.push_back(
        collider_of(Plane{plane.point, plane.normal}, plane.friction, kSurfaceOffset));
  });
  return scene;
}

CoursePlaces::CoursePlaces(const CourseFile& file)
    : pairs_{{"/cloth/pinned", "/cloths/0/pins"},
             {"/cloth/num_width_points", "/cloths/0/grid/points/0"},
             {"/cloth/num_height_points", "/cloths/0/grid/points/1"},
             {"/cloth/width", "/cloths/0/grid/u"},
             {"/cloth/height", "/cloths/0/grid/v"},
             {"/cloth/orientation", "/cloths/0/grid/origin"},
             {"/cloth/thickness", "/cloths/0/self_collision/thickness"},
             {"/cloth/damping", "/cloths/0/drag"},
             {"/cloth/density", "/cloths/0/particle_mass"},
             {"/cloth/ks", "/cloths/0/stiffness"},
             {"/cloth", "/cloths/0"}} {
  int number = 0;
  each_body(file, "sphere", [&](const Json&, const std::string& place) {
    pairs_.push_back({place, "/colliders/" + std::to_string(number++)});
  });
  each_body(file, "plane", [&](const Json&, const std::string& place) {
    const std::string collider = "/colliders/" + std::to_string(number++);
    pairs_.push_back({place + "/normal", collider + "/plane/normal"});
    pairs_.push_back({place, collider});
  });
  pins_ = first_pins(file.document);
  const Json* cloth = member(file.document, "cloth");
  const Json* pinned = cloth ? member(*cloth, "pinned") : nullptr;
  if (pinned && pinned->is_array()) repeated_ = pinned->size() - pins_.size();
  if (repeated_ == 0) pins_.clear();
}

std::string CoursePlaces::in_scene(const std::string& place) const {
  for (const auto& [course, scene] : pairs_)
    if (starts(place, course)) return scene + place.substr(course.size());
  return place;
}

std::string CoursePlaces::in_file(const std::string& place) const {
  const std::string pins = "/cloths/0/pins/";
  if (!pins_.empty() && place.starts_with(pins))
    return "/cloth/pinned/" + std::to_string(pins_.at(std::stoul(place.substr(pins.size()))));
  for (const auto& [course, scene] : pairs_)
    if (starts(place, scene)) return course + place.substr(scene.size());
  return place;
}

}  // namespace weft::text
