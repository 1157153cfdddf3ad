// Which squares of sheets are near each other: the pairs that contact among surfaces measures.
//
// Pairs are listed whose distance is less than what they are kept apart by, and a skin beyond. As long as no two that
// may touch have moved so far against each other (blocks.h), no others can touch. Then all are found again, by the
// same search as particles (pair_search.h).
//
// From this list a shorter one is pruned, of what may come within range while bodies keep to their allowances
// (allowances.h). Most of the others sleep: how far apart they are is measured when they are looked at, and they are not
// looked at again before their squares have come as far. Pairs that share a corner sleep until their corners have come far enough from each other
// (corner_ways.h). So what is measured in an interval are those that may touch in it, and few others.
//
// Those that share a corner are looked at apart (beside_squares.h; of meshes beside_triangles.h). Triangles
// that seams bring beside each other are no pairs (over_seams.h).
#pragma once

#include <memory>
#include <vector>

#include "physics/contact/self/allowances.h"
#include "physics/contact/self/beside_squares.h"
#include "physics/contact/self/beside_triangles.h"
#include "physics/contact/self/corner_ways.h"
#include "physics/contact/self/mesh_squares.h"
#include "physics/contact/self/over_seams.h"
#include "physics/contact/self/pair_search.h"

namespace weft::physics {

class NearSquares {
 public:
  // Particles of sheets are bodies, named as in pair_search.h, and so are the squares of grids that begin
  // with them; those of meshes (mesh_squares.h) have the numbers beyond. `rest`: of every body.
  NearSquares(const std::vector<Sheet>& sheets, const std::vector<NamedSheet>& named,
              const Blocks& blocks, const std::vector<RestPlace>& rest, const KernelTable& kernels);

  const std::vector<Square>& squares() const { return squares_; }
  // What each of them owns; empty: all own all.
  const std::vector<std::uint8_t>& owned() const { return owned_; }

  // m; that squares whose pairs were not listed may move against each other before they can touch.
  float skin() const { return skin_; }
  // Squares with a particle that is marked, by its number, sheet after sheet, are left out from the next list on.
  void leave_out(const std::vector<std::uint8_t>& marked);
  // Lists pairs anew, with the bodies where they are now.
  void list(const Place* now, Threads& threads);
  // The same where a list made before, which was kept, still serves: what may touch as long as that serves.
  void list_again(const Place* now, Threads& threads);
  // Whether squares that were torn when pairs were listed are whole now, so that pairs are to be listed anew.
  bool any_joined(const Place* now) const;
  // No pair sleeps: bodies are elsewhere than where within() left them.
  void wake();
  // A body that was where it is now has been put elsewhere, so far [m].
  void shift(std::int32_t body, float way);
  // Of the listed pairs those that come within `range` of each other in an interval [m], and of those
  // that share a corner what does not lie flat. Once an interval, always with the same range: pairs sleep.
  const SquarePairs& within(float range, const Place* place, const Displacement* moved,
                            Threads& threads);
  // Of those found last what comes within a shorter range in the same interval, when nothing moves
  // otherwise by more than half of the difference.
  const SquarePairs& still_within(float range, const Place* place, const Displacement* moved,
                                  Threads& threads);
  // Of all listed pairs, whether they sleep or not, those of squares with a body that is marked; the others have come to
  // move otherwise by no more than `most` [m] since within().
  const SquarePairs& strayed_within(float range, float most,
                                    const std::vector<std::uint8_t>& strayed, const Place* place,
                                    const Displacement* moved, Threads& threads);

  // Which squares are left out; pairs are listed again after that was put back.
  void keep(Keeper& keeper);
  std::size_t bytes() const;

 private:
  struct LeftOut {
    std::int32_t number;
    float most_squared;  // m², of a corner's distance from the middle: nearer, it is whole
  };

  struct Room {                   // of one piece of a list
    SquarePairs asked;            // numbers: of pairs
    std::vector<float> measured;  // of those asked for
  };

  // The squares of a mesh.
  struct Part {
    std::size_t first, end;
    BesideTriangles beside;
  };

  void make_squares();
  void make_parts(const std::vector<RestPlace>& rest);
  bool beside(std::int32_t p, std::int32_t q) const;
  template <class Visit>
  void share_squares(Threads& threads, const Visit& visit) const;
  void come_apart(const Displacement* moved, Threads& threads);
  void bound_square(std::size_t n, const Place* place, const Displacement* moved);
  template <class Drop>
  static void drop_pairs(SquarePairs& pairs, const Drop& drop);
  void prune(float range, const Place* place, const Displacement* moved, Threads& threads);
  void widen_boxes(const Place* place, Threads& threads);
  void drop_beyond_allowances(SquarePairs& pairs, float range, const Place* place, Room& room);
  template <class Until, class Sleeps>
  void drop_asleep(SquarePairs& pairs, std::size_t turn, const Until& until, const Place* place,
                   Room& room, const Sleeps& sleeps) const;
  bool sleeps(const SquarePairs& pairs, std::size_t pair, float farther);
  void drop_far(SquarePairs& pairs, float range, const Place* place, Room& room);
  void drop_alike(SquarePairs& pairs, const Place* place, Room& room);
  float box_gap(std::int32_t a, std::int32_t b) const;
  template <class Work>
  void add_pieces(std::size_t pairs, SquarePairs& to, Threads& threads, const Work& work);
  void find_not_apart(const SquarePairs& pairs, std::size_t first, std::size_t count, float range,
                      const Place* place, const Displacement* moved, SquarePairs& found) const;
  void keep_not_apart(float range, const Place* place, const Displacement* moved,
                      SquarePairs& found) const;
  void add_asked_beside(float range, float box_range, const Place* place, const Displacement* moved,
                        Threads& threads);
  void add_asked(const SquarePairs& pairs, float range, float box_range, const Place* place,
                 const Displacement* moved, Threads& threads);
  template <class Visit>
  void for_each_body(const Visit& visit) const;
  template <class Visit>
  void for_each_square(const Visit& visit) const;
  float middle_of(std::size_t square, const Place* now, float (&middle)[3]) const;
  void list(const Place* now, float skin, const std::vector<LeftOut>* left_out, Threads& threads);
  float list_whole(const Place* now, const std::vector<LeftOut>* left_out, Spread& box,
                   std::size_t& count);
  void fill_box(std::size_t sorted, const Place* now);
  void find_in(std::size_t chunk, float skin);
  void wake_listed();

  const std::vector<Sheet>& sheets_;
  const std::vector<NamedSheet>& named_;
  const KernelTable& kernels_;
  std::vector<Square> squares_;
  std::vector<std::int32_t> stride_;  // of every body's sheet
  std::vector<std::uint8_t> owned_;
  std::vector<float> most_squared_;  // m², of every square, as LeftOut::most_squared
  std::vector<std::unique_ptr<Part>> parts_;
  const OverSeams seams_;
  CornerWays ways_;        // of grids
  Allowances allowances_;  // since the list was pruned
  BesideSquares beside_;

  PairSearch search_;                  // among the middles of squares that are whole
  std::vector<std::uint8_t> asked_;    // squares whose pairs are looked at anew
  std::vector<std::int32_t> sorted_;   // numbers of squares as sorted by the search
  std::vector<SquareBox> boxes_;       // as sorted, or of all in an interval
  std::vector<SquarePairs> found_;     // of every chunk of the search, or of the list
  std::vector<LeftOut> left_out_;      // squares that are torn
  std::vector<std::uint8_t> passing_;  // vertices of squares that are left out; empty: none
  SquarePairs listed_, pruned_, within_, still_;
  SquarePairs corner_pairs_;      // those that share a corner, before they are looked at
  std::vector<float> until_;      // m, in ways, of every listed pair, until when it sleeps
  std::vector<float> allowance_;  // m, of every square: the greatest of its corners,
  std::vector<float> way_;        // and how far it has come at most, with that
  std::vector<Room> rooms_;       // of every piece of a list
  std::size_t turn_ = 0, prunes_ = 0;
  float within_range_ = 0;     // m: of within_
  float most_ = 0, skin_ = 0;  // m: most_ is what any pair is kept apart at most
  std::size_t all_squares_ = 0;
  bool awake_ = true;   // all pairs are
  bool boxed_ = false;  // boxes are about squares in this interval
};

}  // namespace weft::physics
