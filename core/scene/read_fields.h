// JSON -> fields. Reads what has the right form and leaves the rest as it is: whether all is right
// is the schema's business (schema.h), and what is well is read even beside what is not.
#pragma once

#include <concepts>
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "scene/fields.h"
#include "scene/json_text.h"

namespace weft::text {

class FieldReader {
 public:
  explicit FieldReader(const Json& object) : object_(object) {}

  template <class T>
  void operator()(const char* key, T&& field) {
    if (const Json* value = member(object_, key)) read(*value, field);
  }

  void operator()(Shape& shape) {
#define WEFT_READ_SHAPE(Type, name) read_shape<Type>(#name, shape);
    WEFT_SHAPES(WEFT_READ_SHAPE)
#undef WEFT_READ_SHAPE
  }

  static void read(const Json& value, double& field) {
    if (value.is_number()) field = value.get<double>();
  }

  static void read(const Json& value, int& field) {
    double number = field;
    read(value, number);
    if (number >= INT32_MIN && number <= INT32_MAX) field = static_cast<int>(number);
  }

  static void read(const Json& value, bool& field) {
    if (value.is_boolean()) field = value.get<bool>();
  }

  static void read(const Json& value, std::string& field) {
    if (value.is_string()) field = value.get<std::string>();
  }

  static void read(const Json& value, Vec3& field) {
    if (value.is_array() && value.size() == 3)
      for (std::size_t k = 0; k < 3; ++k) read(value[k], field[k]);
  }

  static void read(const Json& value, std::array<double, 2>& field) {
    if (value.is_array() && value.size() == 2)
      for (std::size_t k = 0; k < 2; ++k) read(value[k], field[k]);
  }

  static void read(const Json& value, BoxCorners& field) {
    if (value.is_array() && value.size() == 2)
      for (std::size_t k = 0; k < 2; ++k) read(value[k], field[k]);
  }

  static void read(const Json& value, Seam& field) {
    if (value.is_array() && value.size() == 2)
      for (std::size_t k = 0; k < 2; ++k) read(value[k], field[k]);
  }

  template <class T>
  static void read(const Json& value, std::optional<T>& field) {
    read(value, field.emplace());
  }

  static void read(const Json& value, VectorInTime field) {
    read(value, field.value);
    FieldReader walk(value);
    walk("keys", field.keys);
  }

  static void read(const Json& value, RestShape field) {
    read(value, field.file);
    field.rest = field.file.empty() ? MeshRest::shape : MeshRest::file;
    read(value, field.rest);
    if (field.rest != MeshRest::file) field.file.clear();
  }

  static void read(const Json& value, Substeps field) {
    if (value == "auto")
      field.value = kAutoSubsteps;
    else
      read(value, field.value);
  }

  static void read(const Json& value, Points field) {
    if (!value.is_array() || value.size() != 2) return;
    read(value[0], field.nx);
    read(value[1], field.ny);
  }

  static void read(const Json& value, Key& field) {
    if (!value.is_array() || value.size() != 4) return;
    read(value[0], field.time);
    for (std::size_t k = 0; k < 3; ++k) read(value[k + 1], field.position[k]);
  }

  static void read(const Json& value, Angle& field) {
    if (!value.is_array() || value.size() != 2) return;
    read(value[0], field.time);
    read(value[1], field.degrees);
  }

  static void read(const Json& value, Share& field) {
    if (!value.is_array() || value.size() != 2) return;
    read(value[0], field.time);
    read(value[1], field.value);
  }

  static void read(const Json& value, ClothPins field) {
    read(value, field.pins);
  }

  static void read(const Json& value, Pin& field) {
    if (value.is_object()) {
      FieldReader walk(value);
      if (const Json* at = member(value, "at")) {
        read(*at, Points{field.i, field.j});
        read(*at, field.i);
      }
      walk("vertices", field.vertices);
      walk("group", field.group);
      walk("box", field.box);
      walk("keys", field.keys);
      walk("rotate", field.rotate);
      walk("follow", field.follow);
    } else if (value.is_number()) {
      read(value, field.i);
    } else {
      read(value, Points{field.i, field.j});
    }
  }

  // One number stands for all three rigidities.
  static void read(const Json& value, Bending& field) {
    double all = 0;
    read(value, all);
    field = all;
    FieldReader walk(value);
    walk("warp", field.warp);
    walk("weft", field.weft);
    walk("twist", field.twist);
    walk("damping", field.damping);
  }

  static void read(const Json& value, Friction& field) {
    if (const Json* course = member(value, "course")) {
      field.model = FrictionModel::course;
      read(*course, field.dynamic);
      field.statik = field.dynamic;
      return;
    }
    read(value, field.dynamic);
    FieldReader walk(value);
    // One of the two stands for both.
    walk("static", field.dynamic);
    walk("dynamic", field.dynamic);
    field.statik = field.dynamic;
    walk("static", field.statik);
    walk("damping", field.damping);
    walk("bias", field.bias);
  }

  template <class T>
  static void read(const Json& value, std::vector<T>& list) {
    if (!value.is_array()) return;
    list.assign(value.size(), T{});
    for (std::size_t k = 0; k < list.size(); ++k) read(value[k], list[k]);
  }

  template <class T>
  requires std::is_enum_v<T>
  static void read(const Json& value, T& field) {
    const auto names = words(T{});
    for (std::size_t k = 0; k < names.size(); ++k)
      if (value == names[k]) field = static_cast<T>(k);
  }

  template <class T>
  requires requires(FieldReader& walk, T& field) {
    fields(walk, field);
  }
  static void read(const Json& value, T& field) {
    FieldReader walk(value);
    fields(walk, field);
  }

 private:
  template <class T>
  void read_shape(const char* key, Shape& shape) {
    if (const Json* value = member(object_, key)) read(*value, shape.emplace<T>());
  }

  const Json& object_;
};

}  // namespace weft::text
