#include "scene/document.h"

#include <cmath>
#include <utility>

#include "scene/read_fields.h"
#include "scene/schema.h"

namespace weft::text {
namespace {

// Fields -> JSON, the mirror image of FieldReader.
class FieldWriter {
 public:
  template <class T>
  void operator()(const char* key, T&& field) {
    put(object_, key, write(field));
  }

  void operator()(Shape& shape) {
    std::visit([&](auto& one) { put(object_, kShapeNames[shape.index()], write(one)); }, shape);
  }

  // Whole numbers without a fraction; the sign of zero is kept.
  static Json write(double field) {
    const bool whole = std::trunc(field) == field && std::abs(field) < 1e15;
    if (whole && !(field == 0 && std::signbit(field))) return static_cast<std::int64_t>(field);
    return field;
  }

  static Json write(int field) { return field; }
  static Json write(bool field) { return field; }
  static Json write(const std::string& field) { return field; }

  static Json write(const Vec3& field) {
    return Json::array({write(field[0]), write(field[1]), write(field[2])});
  }

  static Json write(const std::array<double, 2>& field) {
    return Json::array({write(field[0]), write(field[1])});
  }

  static Json write(const Seam& field) { return Json::array({write(field[0]), write(field[1])}); }

  static Json write(VectorInTime field) {
    if (field.keys.empty()) return write(field.value);
    Json object = Json::object();
    object["keys"] = write(field.keys);
    return object;
  }

  static Json write(RestShape field) {
    return field.rest == MeshRest::file ? Json(field.file) : write(field.rest);
  }

  static Json write(Substeps field) {
    if (field.value == kAutoSubsteps) return "auto";
    return field.value;
  }

  static Json write(Points field) { return Json::array({field.nx, field.ny}); }

  static Json write(const Key& key) {
    const Vec3& p = key.position;
    return Json::array({write(key.time), write(p[0]), write(p[1]), write(p[2])});
  }

  static Json write(const Angle& angle) {
    return Json::array({write(angle.time), write(angle.degrees)});
  }

  static Json write(const Share& share) {
    return Json::array({write(share.time), write(share.value)});
  }

  // What lies beside a mesh's only row is told by its place there, so that it is refused.
  static Json write(Pin& pin, bool of_mesh) {
    Json at = of_mesh && pin.j == 0 ? Json(pin.i) : write(Points{pin.i, pin.j});
    if (pin == Pin{pin.i, pin.j, {}, {}, -1}) return at;
    Json object = Json::object();
    if (!pin.vertices.empty()) object["vertices"] = write(pin.vertices);
    if (pin.group) object["group"] = *pin.group;
    if (pin.box) object["box"] = Json::array({write((*pin.box)[0]), write((*pin.box)[1])});
    if (!pin.of_several()) object["at"] = std::move(at);
    if (!pin.keys.empty()) object["keys"] = write(pin.keys);
    if (pin.rotate != Rotation{}) object["rotate"] = write(pin.rotate);
    if (pin.follow != -1) object["follow"] = write(pin.follow);
    return object;
  }

  static Json write(ClothPins field) {
    Json list = Json::array();
    list.get_ref<Json::array_t&>().reserve(field.pins.size());
    for (Pin& pin : field.pins) list.push_back(write(pin, field.of_mesh));
    return list;
  }

  static Json write(const Bending& bending) {
    if (bending.plain()) return write(bending.warp);
    Json object = Json::object();
    object["warp"] = write(bending.warp);
    object["weft"] = write(bending.weft);
    object["twist"] = write(bending.twist);
    object["damping"] = write(bending.damping);
    return object;
  }

  static Json write(const Friction& friction) {
    Json object = Json::object();
    if (friction.model == FrictionModel::course) {
      object["course"] = write(friction.dynamic);
    } else {
      const bool damps = friction.damping != 0 || friction.bias != 0;
      if (friction.statik == friction.dynamic && !damps) return write(friction.dynamic);
      object["static"] = write(friction.statik);
      object["dynamic"] = write(friction.dynamic);
      if (damps) {
        object["damping"] = write(friction.damping);
        object["bias"] = write(friction.bias);
      }
    }
    return object;
  }

  template <class T>
  static Json write(std::vector<T>& list) {
    Json array = Json::array();
    array.get_ref<Json::array_t&>().reserve(list.size());
    for (T& item : list) array.push_back(write(item));
    return array;
  }

  template <class T>
  requires std::is_enum_v<T>
  static Json write(T field) {
    const auto names = words(T{});
    const auto k = static_cast<std::size_t>(field);
    if (k < names.size()) return names[k];
    return static_cast<int>(field);  // a value outside of the enum: the schema faults the number
  }

  template <class T>
  requires requires(FieldWriter& walk, T& field) { fields(walk, field); }
  static Json write(T& field) {
    FieldWriter walk;
    fields(walk, field);
    return std::move(walk.object_);
  }

 private:
  Json object_ = Json::object();
};

}  // namespace

Scene scene_of(const Json& document) {
  Scene scene;
  FieldReader::read(document, scene);
  return scene;
}

Json document_of(Scene scene) {
  Json document = Json::object();
  document["weft"] = 1;
  Json fields = FieldWriter::write(scene);
  for (auto it = fields.begin(); it != fields.end(); ++it) put(document, it.key(), std::move(*it));
  return document;
}

void drop_defaults(const Json& schema, Json& value) {
  const Json* chosen = alternative(schema, value);
  if (!chosen || !value.is_structured()) return;
  if (value.is_array()) {
    if (const Json* items = member(*chosen, "items"))
      for (Json& item : value) drop_defaults(*items, item);
    return;
  }
  Json kept = Json::object();
  for (auto it = value.begin(); it != value.end(); ++it) {
    const Json* property = descend(*chosen, nullptr, it.key());
    if (property) drop_defaults(*property, *it);
    const Json* standard = property ? member(*property, "default") : nullptr;
    if (!standard || *standard != *it) put(kept, it.key(), std::move(*it));
  }
  value = std::move(kept);
}

}  // namespace weft::text
