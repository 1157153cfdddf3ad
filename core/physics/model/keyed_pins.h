#pragma once

#include "physics/model/cloth_model.h"

namespace weft::physics {

// Held particles that move along keys, turn or follow a collider are put where they are; null where no pin
// moves.
std::unique_ptr<RowStage> make_keyed_pins(const ClothParts& parts);

}  // namespace weft::physics
