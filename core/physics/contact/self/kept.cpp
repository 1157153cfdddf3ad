// What snapshots keep of contact between sheets.
#include <utility>

#include "physics/contact/self/self_contact.h"
#include "physics/step/keeper.h"

namespace weft::physics {

// Lists only save a search: what they were made of is kept, and pairs are searched for again when that is put back.
void SelfContact::keep(Keeper& keeper, bool apart) {
  for (bool* is : {&begun_, &listed_, &forced_, &touched_}) keeper(*is);
  keeper(skin_);
  keeper(kept_runs_);
  keeper(record_);
  blocks_.keep(keeper);
  answer_.keep(keeper);
  if (spheres_) spheres_->keep(keeper);
  if (surfaces_) surfaces_->keep(keeper);
  if (near_) near_->keep(keeper);
  if (apart) keeper(place_);
  if (!keeper.puts_back()) return;
  lost_ = listed_;
  if (near_) near_->wake();
  if (apart) return;
  Threads one(1);
  gather(one);
  std::swap(place_, now_);
}

// Boxes and edges as measured last say when contact comes again, and so what comes of it.
void Blocks::keep(Keeper& keeper) {
  keeper(blocks_);
  keeper(bounds_);
  keeper(before_);
  keeper(flat_);
  for (std::vector<Flat>& pairs : flat_patches_) keeper(pairs);
  keeper(edges_);
  keeper(active_);
  for (std::size_t s = 0; active_ > 0 && s < sheets_.size(); ++s)
    sheets_[s].points->keep(then_[s], keeper);
}

void NearSquares::keep(Keeper& keeper) {
  keeper(left_out_);
  keeper(passing_);
}

}  // namespace weft::physics
