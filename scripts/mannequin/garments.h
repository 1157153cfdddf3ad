// Clothes that lie about the figure as it stands, in one piece.
#pragma once

#include "figure.h"
#include "net.h"

namespace mannequin {

// A shirt with short sleeves: the surface so far off trunk and arms, without what is beyond neck, hem and cuffs.
Mesh make_shirt(const Figure& figure);

}  // namespace mannequin
