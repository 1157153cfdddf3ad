// Sleeping: which row-blocks of the cloths are asleep.
//
// At the end of a frame a block is quiet when all its particles have come less far than the scene's
// `sleep` would carry them: how they shiver within the frame, by contact or rounding, does not count.
// Quiet for half a second, between neighbours that are quiet too, it falls asleep: its velocities
// become 0, its particles are held (inverse mass 0), and rows out of the stages' reach from awake
// ones are not worked on. It wakes when a block beside it is no longer quiet or, where cloths collide,
// one comes near; when a collider or a pin that moves comes near; and when a caller changes the cloth.
// All is decided between frames and by the state alone, so that no number of threads changes it.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "physics/frame/cloth_step.h"
#include "physics/kernels/contact.h"

namespace weft::physics {

class Sleeping {
 public:
  // Null when nothing of the scene may rest: `sleep` is 0, or there are gusts, or loads over time.
  static std::unique_ptr<Sleeping> make(const Scene& scene, const Cloths& cloths,
                                        const KernelTable& kernels);

  // Wakes what a collider or a pin reaches in the frame from `time` on.
  void begin_frame(double time);
  // Looks at the frame that has run, from positions `before`(cloth): what falls asleep, what wakes.
  template <class Before>
  void end_frame(const Before& before) {
    for (std::size_t c = 0; c < cloths_.size(); ++c)
      for (Block& b : cloths_[c].blocks)
        if (!b.asleep) look(cloths_[c], b, before(c));
    decide();
  }
  // A caller changes a cloth: all of it wakes.
  void wake(int cloth);
  // Takes over inverse masses that a caller changed while the cloth was awake.
  void keep_masses(int cloth);

  void keep(Keeper& keeper);

  // The rows of a cloth to work on; empty: all of it is asleep.
  std::span<const RowSpan> rows(std::size_t cloth) const { return cloths_[cloth].awake; }
  bool all_asleep() const;
  // Inverse masses of a cloth, those of sleeping particles as when awake [1/kg].
  const AlignedArray<float>& masses(std::size_t cloth) const { return cloths_[cloth].masses; }
  std::int64_t asleep() const;  // particles, now
  double share() const;         // of all rows and frames so far that were slept through, 0 … 1
  std::size_t bytes() const;

 private:
  struct Block {
    RowSpan rows;
    int quiet_frames = 0;
    bool quiet = false, asleep = false;
    Spread box{};  // of its particles now and a frame later; only where something may come near
  };
  struct Moving {  // a pin on a path
    const Pin* pin;
    Particles::Place at;
  };
  struct Resting {
    ClothStep* step = nullptr;
    AlignedArray<float> masses;
    std::vector<Moving> moving;
    std::vector<Block> blocks;
    std::vector<RowSpan> awake;
    int reach = 0;  // rows, of the stages
  };

  Sleeping(const Scene& scene, const Cloths& cloths, const KernelTable& kernels);
  void look(Resting& cloth, Block& block, const Rows& before) const;
  bool is_quiet(const Resting& cloth, const Block& block, const Rows& before) const;
  void decide();
  bool beside_restless(const Resting& cloth, std::size_t block) const;
  bool met_by_restless(const Block& block) const;
  bool met_by_collider(const Block& block, double time) const;
  bool pulled(const Resting& cloth, const Block& block, double time) const;
  void set_asleep(Resting& cloth, Block& block, bool asleep);
  void list_awake(Resting& cloth);

  const Scene& scene_;
  const KernelTable& kernels_;
  int frames_to_sleep_;
  double contact_ = 0;  // m; blocks that come as near may touch; 0: cloths do not collide
  std::vector<Resting> cloths_;
  std::int64_t rows_slept_ = 0, rows_seen_ = 0;
};

// Whether all of a cloth is asleep. `sleeping`: null where nothing may sleep.
inline bool is_asleep(const Sleeping* sleeping, std::size_t cloth) {
  return sleeping && sleeping->rows(cloth).empty();
}

}  // namespace weft::physics
