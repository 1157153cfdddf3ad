// Self-collision, mode `particles`: no two particles of any cloths nearer than the thickness, except
// neighbours, those hardly farther than that from each other on the flat sheet.
//
// Sheets are cut into blocks (blocks.h). Those that nothing can touch, themselves included, are left
// out; the particles of the others are searched for pairs within the range, the thickness and a skin
// (cell_grid.h). The list stays complete until blocks that may touch have moved by more than the skin
// against each other (Verlet 1967), and is made anew then. Particles that lie beside each other in a
// sheet, a little farther than neighbours, would be on it all the time and hardly ever touch: they are
// left out, and tested row against row each time (kernels/beside_pairs.cpp).
//
// Blocks are looked at, and pairs pushed apart, as often as the motion asks for: never more than a share
// of the thickness in between, and more often where pairs are found pressed into each other. A pair
// corrects both its ends, all pairs from the same state (Jacobi); what a particle is asked is summed up
// in the order of the lists, whatever the threads. What contact takes from a particle's velocity time
// after time it gives in part beforehand, so that layers that lie on each other do not sink in between
// two times.
#pragma once

#include <memory>
#include <vector>

#include "physics/contact/self/blocks.h"
#include "physics/contact/self/pair_search.h"
#include "physics/model/lattice/stages.h"
#include "weft/scene.h"

namespace weft::physics {

// One particle: which of the sheets, row and column.
struct Site {
  std::uint16_t cloth, row, column;
};

class SelfContact {
 public:
  // Null when no cloth asks for it.
  static std::unique_ptr<SelfContact> make(const Scene& scene,
                                           const std::vector<const LatticeParts*>& cloths,
                                           const KernelTable& kernels);
  ~SelfContact();

  // Pushes apart what is too near at the end of a substep of dt; `since` substeps after the last
  // time. Returns after how many substeps to come again, where sheets touch before what presses them
  // swings: `swing` [s].
  int run(double dt, int since, double swing, Threads& threads);

  // Pairs nearer than the thickness now, and by how much at most [m].
  struct Overlaps {
    std::int64_t pairs = 0;
    double deepest = 0;
  };
  Overlaps overlaps();

  // Searches now for all pairs nearer than the greatest thickness and `margin` [m].
  void search(double margin, Threads& threads);
  // Calls visit(site, other site) for each pair that was found, once.
  template <class Visit>
  void for_each_pair(Visit&& visit) const {
    for (std::size_t k = 0; k < search_.chunks(); ++k) {
      const PairSearch::Pairs pairs = search_.pairs(k);
      for (std::size_t i = 0; i < pairs.count; ++i)
        visit(site(pairs.owner[i]), site(pairs.neighbour[i]));
    }
    for (const PairList& pairs : beside_)
      for (std::size_t i = 0; i < std::size_t(pairs.count); ++i)
        visit(site(pairs.owner[i]), site(pairs.neighbour[i]));
  }

  // One part of a run by itself, for measuring: the sort of what was searched last; its pairs within the
  // thickness and a margin, but for those beside each other; and finding these and pushing all apart.
  void sort(double margin, Threads& threads);
  void find(double margin, Threads& threads);
  struct Met {
    double speed = 0;    // greatest relative one of two that touched [m/s]
    double deepest = 0;  // of the distance at which they are held, before they were pushed apart
  };
  Met respond(double dt, int since, Threads& threads);

  const std::vector<Sheet>& sheets() const { return sheets_; }
  void restart();
  // Share of the times so far that the list of pairs was still complete.
  double kept() const { return runs_ > 0 ? 1 - double(searches_) / double(runs_) : 0; }
  // Share of the particles so far that were in blocks that nothing could touch.
  double passed_over() const;
  std::int64_t particles() const { return std::int64_t(particles_); }
  std::size_t bytes() const;

 private:
  SelfContact(const Scene& scene, std::vector<Sheet> sheets, const KernelTable& kernels);
  struct PairList {
    std::vector<std::int32_t> owner, neighbour;
    int count = 0;
    // For so many, and what kernels may write beyond them.
    PairRoom room(std::size_t pairs);
  };
  struct Touching {
    PairList pairs;
    std::vector<Asked> asked;
  };
  // Of what nothing may touch.
  void forget_loads(const Block& block);
  void forget_loads();
  void list_sites(Threads& threads);
  void put_far_away(const Block& block);
  bool few() const { return found_ + 4 * count_ < 8192; }  // one thread pushes them apart faster
  std::size_t body(std::size_t sheet, int row, int column) const;
  Site site(std::int32_t body) const;
  double most_substeps(double dt, double swing) const;
  BodyBlock bodies_of(const Block& block, double since);
  // A part of the bodies, and those of it that are asked to move.
  struct Part {
    std::vector<std::int32_t> bodies;
    int count = 0;
  };
  // How they are pushed.
  struct Push {
    BodyFriction friction;
    float course_share, inverse_dt;  // MoveBodies
  };
  void gather(double since, bool alone, Threads& threads);
  void push_apart(bool first, const Push& push, bool alone, Threads& threads);
  void list_beside(std::size_t block, float range);
  void list_touching(const PairSearch::Pairs& all, bool anew, PairList& close, Touching& touching);
  AskFound ask(const BodyFriction& friction, Touching& touching);
  void sum_up(std::size_t part, const Touching& touching);
  // Whole groups of 16 bodies, so that no two parts share one.
  std::int32_t first_of_part(std::size_t part) const {
    return part < parts_.size() ? std::int32_t(bodies_ * part / parts_.size() / 16 * 16)
                                : std::int32_t(bodies_);
  }

  const Scene& scene_;
  std::vector<Sheet> sheets_;
  const KernelTable& kernels_;
  const std::size_t particles_;
  Blocks blocks_;
  std::vector<NamedSheet> named_;  // names are the numbers of bodies
  const std::size_t bodies_;
  std::vector<std::vector<SheetStep>> steps_;  // of every sheet, to those beside each other
  PairSearch search_;                          // among the particles of active blocks
  std::vector<std::size_t> first_site_;        // of every block
  std::size_t found_ = 0;                      // pairs
  std::size_t count_ = 0;                      // particles of active blocks
  std::vector<Place> place_;                   // those of active blocks are up to date in a run
  std::vector<Motion> motion_;                 // likewise
  std::vector<float> friction_;  // of every body, or kCourseRule; empty where all are alike
  float friction_alike_ = 0;
  std::vector<Rows> load_, ahead_;                 // of every sheet: BodyBlock
  std::vector<std::vector<std::uint8_t>> loaded_;  // likewise
  std::vector<std::uint8_t> moved_;                // likewise, of all bodies
  std::vector<AskedSum> sums_;                     // of every body; nothing between two rounds
  // The pairs that may touch in this run: of every chunk of the search, and of every block those beside
  // each other.
  std::vector<PairList> close_, beside_;
  std::vector<std::size_t> lists_;     // of these, chunks first, those still looked at
  std::vector<Touching> touching_;     // of each of lists_, or of all in turn
  std::vector<AskFound> found_asked_;  // of every chunk and block
  std::vector<Part> parts_;            // as many as threads
  float thickness_ = 0;                // greatest of the sheets [m]
  bool course_ = false;                // whether any sheet has the course's rule
  bool valid_ = false;
  bool may_touch_ = false;  // whether any sheets do, as seen the last time
  float skin_ = 0;          // of the thickness
  int kept_runs_ = 0;       // since the list of pairs was made
  int most_touching_ = 0;   // substeps between two looks, where sheets touch
  std::int64_t runs_ = 0, searches_ = 0, passed_over_ = 0;
};

}  // namespace weft::physics
