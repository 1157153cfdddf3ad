// Stage "tethers": no free particle is farther from its pins than the cloth between them is long (Kim,
// Chentanez, Müller-Fischer 2012, "Long range attachments"). For nearly inextensible cloth only: real stretch
// would be taken back.
#pragma once

#include "physics/model/cloth_model.h"

namespace weft::physics {

struct Tether {
  int pin = -1;      // number of the particle that is held; -1: none
  double reach = 0;  // m
};

// Slot s has the s-th tether of every particle, by its number; at most kTethers slots. Null: there is none.
// `corrections`, zero before, receive what it finds.
std::unique_ptr<RowStage> make_tethers(const ClothParts& parts,
                                       const std::vector<std::vector<Tether>>& slots,
                                       Rows& corrections);

// Adds a tether to a particle of so many, in the first slot where it has none.
void add_tether(std::vector<std::vector<Tether>>& slots, int particles, int particle,
                const Tether& tether);

}  // namespace weft::physics
