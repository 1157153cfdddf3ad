// Whether pins hold what is there, each particle once, on paths that can be followed.
#pragma once

#include <string>
#include <vector>

#include "scene/schema.h"
#include "weft/scene.h"

namespace weft::text {

// Adds a fault for each pin of a cloth that cannot be held. `place`: of the list of pins.
void check_pins(const Scene& scene, const Cloth& cloth, const std::string& place, Check& result);

// Adds a fault for each key whose time does not come after that of the one before.
template <class AnyKey>
void check_keys(const std::vector<AnyKey>& keys, const std::string& place, Check& result) {
  for (std::size_t k = 1; k < keys.size() && !result.full(); ++k)
    if (keys[k].time <= keys[k - 1].time)
      result.fault(
          place + "/" + std::to_string(k),
          "time " + number_words(keys[k].time) + " comes after " + number_words(keys[k - 1].time),
          "times that increase");
}

// The same of a rotation's keys, and a fault where its axis has no direction.
void check_rotation(const Rotation& rotation, const std::string& place, Check& result);

}  // namespace weft::text
