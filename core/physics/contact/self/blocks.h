// The blocks that sheets are cut into for self-collision, and which of them may touch.
//
// Blocks are far from each other when the boxes about them are: about their particles, and among surfaces about
// all squares or triangles that these are corners of. A block and those beside it always
// meet; they are known not to touch when the sheet is nearly flat there: with every edge along the
// rows within ε_u of one vector U, and every edge across within ε_v of V, two particles a columns and
// b rows apart are at least
//
//   |a U + b V| - |a| ε_u - |b| ε_v >= ρ |a u + b v|,
//   ρ = sqrt(1 - |U·V|/(|U||V|)) min(|U|/|u|, |V|/|v|) - √2 max(ε_u/|u|, ε_v/|v|)
//
// apart, where u and v are the edges at rest, square to each other. So no pair that is 1/ρ thicknesses
// apart at rest touches, and nearer ones are neighbours. (Volino and Magnenat-Thalmann 1994 bound
// normals to the same end.)
#pragma once

#include <limits>
#include <vector>

#include "physics/contact/self/flat_patches.h"
#include "physics/kernels/contact.h"

namespace weft::physics {

// One cloth that takes part: a grid, or a mesh in patches.
struct Sheet {
  ClothModel* model;
  std::unique_ptr<MeshPatches> mesh;  // null: a grid
  Particles* points;                  // the grid's own, or those of the patches
  int columns;                        // of the longest row of points
  float thickness, friction;
  // Rest metric of a grid: |di u + dj v|² [m²]; of a mesh as if its edges were square to each other.
  float uu, uv, vv;
  SelfCollisionResponse response;
  // Thicknesses at rest: neighbours are nearer than that.
  static constexpr float kNeighbour = 1.3f;
  // Thicknesses at rest: pairs nearer than that are none. In the course neighbours push, too, once they are
  // pressed together; only what is that near at rest does not.
  float neighbour() const { return response == SelfCollisionResponse::stiff ? kNeighbour : 1; }
  // Whether particles so many columns and rows from each other are neighbours.
  bool neighbours(int di, int dj) const {
    const float i = float(di), j = float(dj), within = kNeighbour * thickness;
    return i * i * uu + 2 * i * j * uv + j * j * vv < within * within;
  }
  // Where a point is in the cloth's own rows.
  Particles::Place place(int row, int column) const {
    return mesh ? mesh->place(row, column) : Particles::Place{row, column};
  }
};
// Brings the points of meshes to where particles are now.
void copy_meshes(const std::vector<Sheet>& sheets, Threads& threads);
// Of all sheets together.
std::size_t count_particles(const std::vector<Sheet>& sheets);

// Of no values.
inline Spread nothing() {
  constexpr float far = std::numeric_limits<float>::max();
  return {{far, far, far}, {-far, -far, -far}};
}

struct Block {
  int sheet, row, column, rows, columns;
  int across, down;  // its place among the sheet's blocks
  int box_rows,
      box_columns;  // of the particles that its box is about, beyond its own where surfaces meet
  bool active;      // searched for pairs the last time
};

// A block's first particle in the rows of its sheet.
inline Row3 first_of(const Block& block, Rows& rows) {
  const Row3 r = rows.row(block.row);
  return {r.x + block.column, r.y + block.column, r.z + block.column};
}

class Blocks {
 public:
  // A sheet does not touch itself where it is nearly flat: among surfaces where ρ is above `least_ratio`; among
  // particles that is 0, and it must be such that pairs come no nearer than a thickness that are no neighbours at
  // rest (Sheet::neighbour).
  Blocks(const std::vector<Sheet>& sheets, float least_ratio, const KernelTable& kernels);

  const std::vector<Block>& all() const { return blocks_; }
  // Where the particles of a sheet were when last remembered.
  const Rows& then(std::size_t sheet) const { return then_[sheet]; }

  // An interval begins where all is now.
  void begin(Threads& threads);
  // Bounds of every block since the interval before was measured or begun, and as its particles are now.
  // What is not known to be nearly flat counts as not flat, until all edges are measured again.
  void measure(Threads& threads);
  void measure_edges(Threads& threads);

  struct Outlook {
    bool covered;    // all pairs that may touch, or soon will, are active and have moved little
    double seconds;  // until the next look
    bool touching;   // some may touch
  };
  // `reach`: within which blocks may touch; `skin`: how far active ones may move against each other;
  // `motion`: the same between two looks [m]; `longest`: until the next look [s].
  Outlook look(float reach, float skin, float motion, double longest);

  // Makes active what may touch within `reach`, or all, and remembers where it is. Edges are to be
  // measured before.
  void choose(float reach);
  void choose_all();
  Spread box() const;  // about the active blocks, as measured [m]
  void keep(Keeper& keeper);
  std::size_t active() const { return active_; }
  std::size_t bytes() const;

 private:
  struct Flat {
    float ratio = 0;   // ρ of a block and those beyond it along the row, the column and both
    float needed = 1;  // for nothing to touch there
    float rate = 0;    // at most so much less in a second [1/s]
  };
  void cut(const std::vector<Sheet>& sheets);
  BlockRows rows_of(std::size_t b);
  bool surfaces() const { return least_ratio_ > 0; }
  void measure_block(std::size_t b);
  void measure_border(std::size_t b);
  void measure_flat(bool all);
  Flat flat(std::size_t b) const;
  Flat flat(const Sheet& sheet, const BlockBounds& all) const;
  Flat flat(std::size_t sheet, const FlatPatches::Pair& pair) const;
  void measure_edges(std::size_t b);
  void measure_flat_patches(std::size_t sheet, bool all);
  void add_edges(std::size_t other, BlockBounds& all) const;
  template <class Visit>
  void for_each_of_square(std::size_t b, const Visit& visit) const;
  // How flat a sheet is about two of its blocks beside each other, a <= b: of a grid over a square of four
  // blocks that holds both. Null when they are not.
  const Flat* flat_about(std::size_t a, std::size_t b) const;
  template <class Visit>
  void for_each_near(float distance, Visit&& visit);
  void remember();

  const std::vector<Sheet>& sheets_;
  const float least_ratio_;
  const KernelTable& kernels_;
  std::vector<Block> blocks_;
  struct Extent {
    int first, across, down;
  };
  std::vector<Extent> extents_;  // of every sheet, in blocks
  // Of every block of a mesh among surfaces: vertices of other patches that its triangles have.
  std::vector<std::vector<Particles::Place>> borders_;
  std::vector<BlockBounds> bounds_;
  std::vector<Spread> before_;  // boxes at the interval's start
  std::vector<Flat> flat_;
  std::vector<std::unique_ptr<FlatPatches>> patches_;  // of every sheet, null of grids,
  std::vector<std::vector<Flat>> flat_patches_;        // and of every pair of these
  std::vector<std::uint8_t> edges_;       // whether a block is of a square that is nearly flat
  AlignedArray<float> low_[3], high_[3];  // of bounds_.x
  std::vector<std::int32_t> near_;        // of one block, which others,
  std::vector<float> near_squared_;       // and how far their boxes are
  std::vector<Rows> then_;
  std::size_t active_ = 0;
};

}  // namespace weft::physics
