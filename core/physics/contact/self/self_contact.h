// Contact of cloths with themselves and with each other: among particles (mode `particles`, spheres of the
// thickness) or among surfaces (mode `surface`, vertices against triangles and edges against edges; if
// one cloth asks for it, it holds for all that take part). Both follow one rule.
//
// After every substep where anything touches, else every few, with x₀ where all was the last time, u =
// x - x₀ what it has moved since, and D the seconds in between:
//
//   1. Contacts: pairs nearer than h at x₀ or, by u, now. Normals, distances and sides are those at x₀.
//   2. Impulses on u (contact_solver.h): things approach until they are h apart, no further when nearer,
//      and what touches does not slide, or slides against friction. Nothing here pushes apart.
//   3. v += Δu/D, x += Δu: momentum is kept, and energy is lost or kept. In one substep that is what an
//      impulse on velocities before it does; of several it is the last that it acts in, or positions would
//      leave those behind that have not been touched, and stretch what is between.
//   4. What is nearer than h all the same is put apart by a share of what is missing, in positions
//      alone, and slowly: pushing apart makes no speed.
//   5. Surfaces: what could still pass through moves as one (passing.cpp).
//
// (Bridson, Fedkiw, Anderson 2002; friction on displacements is static friction: nothing creeps.) Where
// nothing touches, nothing is changed, not a bit.
//
// Sheets are cut into blocks (blocks.h). Those that nothing can touch, themselves included, are left
// out. Pairs are searched for within h and a skin, by a spatial hash (spatial_hash.h); the list stays
// complete until blocks that may touch have moved by more than the skin against each other (Verlet
// 1967). Particles that lie beside each other in a sheet, a little farther than neighbours, would be on
// the list all the time and hardly ever touch: they are left out, and tested row against row each time
// (kernels/beside_pairs.cpp).
//
// The response `course` is the course's own rule (course_response.cpp): among particles of such sheets; with
// the response `neighbours`, among neighbours on the grid alone.
#pragma once

#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "physics/contact/self/blocks.h"
#include "physics/contact/self/body_answer.h"
#include "physics/contact/self/contact_solver.h"
#include "physics/contact/self/near_squares.h"
#include "physics/contact/self/pair_search.h"
#include "weft/scene.h"

namespace weft::physics {

// One particle: which of the sheets, row and column of its points.
struct Site {
  std::uint16_t cloth, row, column;
};

class SelfContact {
 public:
  // Null when no cloth asks for it.
  static std::unique_ptr<SelfContact> make(const Scene& scene,
                                           const std::vector<ClothModel*>& cloths,
                                           const KernelTable& kernels);
  ~SelfContact();

  // An interval begins where all is now; nothing has crossed but what is left alone. Not needed after
  // run(), which ends one interval and begins the next.
  void begin(Threads& threads);
  bool begun() const { return begun_; }
  // Ends an interval. Returns after how many substeps to come again, a power of two.
  int run(const ContactInterval& interval, Threads& threads);

  // Positions or velocities are others than run() left.
  void restart();
  // Positions alone are what they were before.
  void go_back() { begun_ = false; }
  // After restart(), with particles put back. `apart`: particles have moved since the last run.
  void keep(Keeper& keeper, bool apart);

  bool surfaces() const { return near_ != nullptr; }
  // Squares that have a marked particle are left alone from the next restart on (untangle.h).
  void leave_out(const std::vector<std::uint8_t>& marked) { near_->leave_out(marked); }
  // Whether something may have crossed all the same since last asked: pins that a path has drawn through.
  bool forced() { return std::exchange(forced_, false); }

  // Pairs nearer than the thickness now, and by how much at most [m]: of particles, or of vertices and
  // triangles and of edges.
  struct Overlaps {
    std::int64_t pairs = 0;
    double deepest = 0;
  };
  Overlaps overlaps();

  // Searches now for all pairs nearer than the greatest thickness and `margin` [m].
  void search(double margin, Threads& threads);
  // Calls visit(site, other site) for each pair of particles that was found, once.
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
  // thickness and a margin, but for those beside each other.
  void sort(double margin, Threads& threads);
  void find(double margin, Threads& threads);

  const std::vector<Sheet>& sheets() const { return sheets_; }
  std::int64_t particles() const { return std::int64_t(particles_); }

  // So far.
  struct Record {
    std::int64_t runs = 0, searches = 0;  // times that contact ran, and lists were made anew
    double passed_over = 0;  // particles in blocks that nothing could touch, of all runs
    std::int64_t contacts = 0, sweeps = 0;  // of all runs
    std::int64_t contacts_now = 0;          // of the last
    double energy_taken = 0;                // J, of motion, by impulses
    std::int64_t held = 0;      // particles whose motion was cut so that nothing passes,
    double greatest_held = 0;   // by how much at most [m]
    double least_distance = 1;  // of two that touched, of the distance held
    double missing_now = 0;     // of the distance held, at most, after the last run
  };
  const Record& record() const { return record_; }
  // Whether contact changed anything the last time.
  bool touched() const { return touched_; }
  std::size_t bytes() const;

 private:
  SelfContact(const Scene& scene, std::vector<Sheet> sheets, bool surfaces,
              const KernelTable& kernels);
  struct PairList {
    std::vector<std::int32_t> owner, neighbour;
    int count = 0;
    // For so many, and what kernels may write beyond them.
    PairRoom room(std::size_t pairs);
    void pad();
  };

  // Contacts of surfaces, in a room that is used again.
  struct Measured {
    std::vector<SurfaceContact> room;
    std::size_t count = 0;
    std::span<const SurfaceContact> found() const { return {room.data(), count}; }
  };

  // Rows of a sheet that are gathered in one go.
  struct Band {
    std::size_t sheet;
    int row, rows;
  };

  // What contact changes of a sheet; `history` may be null.
  struct Moving {
    Particles* particles;
    History* history;
  };

  std::size_t body(std::size_t sheet, int row, int column) const;
  Site site(std::int32_t body) const;
  BodyBlock bodies_of(const Band& band);
  void gather(Threads& threads);
  void place_at_rest(std::size_t sheet);
  void list_neighbours(std::size_t sheet);
  bool near_at_rest(std::int32_t a, std::int32_t b) const;

  // self_contact.cpp: when, and the lists of pairs.
  void list_sites(Threads& threads);
  float skin() const { return near_ ? near_->skin() : skin_ * thickness_; }
  void list_pairs(float reach, Threads& threads);
  void list_again(float reach, Threads& threads);
  void list_beside(std::size_t block, float range);
  bool touches() const { return record_.contacts_now > 0; }

  // contact_response.cpp
  Overlaps find_overlaps();
  void respond(const ContactInterval& interval, Threads& threads);
  void find_among_particles(Threads& threads);
  void find_among_surfaces(Threads& threads);
  void measure_surfaces(const SquarePairs& pairs, SurfaceSearch search, float reach,
                        Threads& threads);
  void keep_owned(const SquarePairs& pairs, std::size_t first, Measured& found) const;
  template <int N>
  void sort(std::vector<Contact<N>>& contacts, std::vector<Contact<N>>& to);
  template <int N>
  void solve(ContactSolver<N>& solver, const ContactInterval& interval, Threads& threads);
  template <int N>
  void scatter(ContactSolver<N>& solver, const ContactInterval& interval);
  float friction_of(std::int32_t a, std::int32_t b) const;

  // passing.cpp
  bool mark_strayed(float most);
  void hold_together(Threads& threads);
  std::int32_t zone_of(std::int32_t body);
  bool join_zones(std::vector<std::int32_t>& members);
  void move_zones(const std::vector<std::int32_t>& members);

  // course_response.cpp
  bool only_neighbours(const Site& a, const Site& b) const;
  bool by_course(std::int32_t a, std::int32_t b) const;
  std::size_t push_by_course(double dt, int steps);

  const Scene& scene_;
  std::vector<Sheet> sheets_;
  const KernelTable& kernels_;
  const std::size_t particles_;
  std::vector<NamedSheet> named_;  // names are the numbers of bodies
  const std::size_t bodies_;
  const float thickness_;  // greatest of the sheets [m]
  Blocks blocks_;
  std::vector<Band> bands_;
  std::vector<std::vector<SheetStep>> steps_;  // of every sheet, to those beside each other
  PairSearch search_;                          // among the particles of active blocks
  std::unique_ptr<NearSquares> near_;          // null among particles
  std::vector<std::size_t> first_site_;        // of every block
  std::size_t count_ = 0;                      // particles of active blocks
  std::vector<RestPlace> rest_;                // of every body,
  std::vector<float> friction_;                // and its coefficient
  // Of every body of a mesh among particles, others that are none to meet.
  std::vector<std::vector<std::int32_t>> neighbours_;
  // Of every body, and of 16 that stand for none: at the interval's start, now, and in between.
  std::vector<Place> place_, now_;
  std::vector<Displacement> moved_;
  std::vector<PairList> meeting_, beside_;  // of chunks of the search, of blocks
  std::vector<Measured> measured_;          // of pieces of the list of squares
  const SquarePairs* pairs_ = nullptr;      // as measured
  std::vector<std::int32_t> begin_;         // of every body's or square's contacts, to sort them
  BodyAnswer answer_;
  std::unique_ptr<ContactSolver<2>> spheres_;
  std::unique_ptr<ContactSolver<4>> surfaces_;
  std::vector<Contact<2>> unsorted_spheres_;
  std::vector<Contact<4>> unsorted_surfaces_;
  std::vector<Moving> moving_;       // of every sheet
  std::vector<Displacement> asked_;  // of every body, by the course's rule: a sum, and of how many
  std::vector<std::int32_t> zone_;   // of every body, its own number outside of any (passing.cpp)
  std::vector<std::uint8_t> strayed_;  // bodies

  bool course_ = false;  // whether any sheet has the course's rule, for neighbours at least
  bool begun_ = false;
  bool listed_ = false;  // whether lists of pairs are there,
  bool lost_ = false;    // or were when the state was kept that was put back
  bool forced_ = false;
  bool touched_ = false;
  float skin_ = 0;     // among particles, of the thickness
  int kept_runs_ = 0;  // since the list of pairs was made
  Record record_;
};

}  // namespace weft::physics
