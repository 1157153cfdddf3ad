// The shapes of colliders.
#pragma once

#include <array>
#include <variant>

#include "weft/shapes/box.h"
#include "weft/shapes/capsule.h"
#include "weft/shapes/cylinder.h"
#include "weft/shapes/mesh_body.h"
#include "weft/shapes/plane.h"
#include "weft/shapes/sphere.h"
#include "weft/shapes/tapered_capsule.h"

namespace weft {

// The type, and the name that scene files and messages have for it. All that goes by shape is made from this
// list: the variant, the reader and the kernels.
#define WEFT_SHAPES(apply)                                                          \
  apply(Sphere, sphere) apply(Plane, plane) apply(Capsule, capsule) apply(Box, box) \
      apply(Cylinder, cylinder) apply(TaperedCapsule, tapered_capsule) apply(MeshBody, mesh)

template <class, class... Shapes>
struct OneOf {
  using type = std::variant<Shapes...>;
};
#define WEFT_TYPE_OF_SHAPE(Type, name) , Type
using Shape = OneOf<void WEFT_SHAPES(WEFT_TYPE_OF_SHAPE)>::type;
#undef WEFT_TYPE_OF_SHAPE

// Their names, in the order of Shape.
#define WEFT_NAME_OF_SHAPE(Type, name) #name,
inline constexpr std::array<const char*, std::variant_size_v<Shape>> kShapeNames{
    WEFT_SHAPES(WEFT_NAME_OF_SHAPE)};
#undef WEFT_NAME_OF_SHAPE

}  // namespace weft
