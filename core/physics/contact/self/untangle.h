// Sheets that pass through each other where contact finds them: at the start, in a state that was set,
// or because a pin on its path was pulled through. Contact keeps apart what is apart, on whichever side;
// here is decided what has to change sides.
//
// Where two surfaces meet in a line, each lies on both sides of the other, and every particle belongs to
// the side of the crossing edge's end that it is the fewest edges from. Of these up to four parts of the
// line the one of least area has to pass: the ends of crossing edges that belong to it are moved through
// the triangles, which come half the way towards them. So the line moves on towards that part's far end,
// row by row, and leaves it there. Lines may end anywhere. (Baraff, Witkin and Kass 2003, Untangling
// Cloth, flood surfaces from lines in the same way, but closed ones.) A fold so tight that the sheet
// crosses itself within a few rows is smoothed instead: its particles move to the middle of their
// neighbours.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "physics/contact/self/crossings.h"
#include "physics/model/cloth_model.h"
#include "weft/scene.h"

namespace weft::physics {

class Untangle {
 public:
  // Over the cloths that take part in self-collision, which live as long.
  Untangle(const Scene& scene, const std::vector<ClothModel*>& cloths);

  // Edges that pass through triangles now.
  std::size_t crossings();
  // Takes note of the ends of seams that are open by more than half of the thickness: triangles with one of
  // them are drawn through others, and are left alone. Returns whether they are others than before; what has
  // closed may cross.
  bool look_at_seams();

  // Something may have crossed.
  void look() {
    due_ = true;
    since_ = 0;
  }
  // At first, where sheets may cross as the scene puts them.
  bool due() const { return due_; }
  // Moves a few rows of what has to pass; nothing is due any more when nothing crosses, or when that
  // has gone on for long: pins may hold what cannot come apart.
  void pull_apart();
  // Taking through stretches sheets, which would fly apart: while anything is due, velocities within each
  // that crosses anything go to their mean, within some milliseconds. Its momentum is kept.
  void calm(double seconds);
  // Particles that have to pass, ends of open seams among them, by their numbers, sheet after sheet:
  // contact leaves them out.
  const std::vector<std::uint8_t>& passing() const { return passing_; }
  void keep(Keeper& keeper);

 private:
  struct Sheet {
    ClothModel* cloth;
    double thickness;        // m
    double area;             // m², of a particle
    int columns;             // of a grid
    std::vector<Vec3> rest;  // m, of the particles of a mesh
    std::size_t first;       // number of its first particle
    bool crosses;            // anything, the last time
  };

  // Of an edge that crosses, with all that it crosses along one line.
  struct End {
    std::int32_t particle, line;  // of crossings: the number of its first
    bool front;                   // of the triangle
    std::int32_t part;            // the number of its first end
    bool passes;
  };

  // Of every particle: sums of ways that it is asked to go [m], and of how many.
  struct Moves {
    std::vector<Vec3> way;
    std::vector<int> asked;
    void ask(std::int32_t particle, const Vec3& by) {
      Vec3& sum = way[std::size_t(particle)];
      for (std::size_t k = 0; k < 3; ++k) sum[k] += by[k];
      ++asked[std::size_t(particle)];
    }
  };

  bool may_cross(const Scene& scene) const;
  void mark_what_crosses();
  void clear_passing();
  void find_lines();
  void list_ends();
  std::size_t first_end(std::int32_t particle) const;
  void choose_parts();
  void choose_part(std::span<const std::int32_t> ends);
  void list_neighbours();
  double area(std::int32_t particle, double pinned) const;
  bool passes(std::int32_t particle, std::int32_t line) const;
  bool in_a_fold(std::int32_t a, std::int32_t b) const;
  Vec3 to_neighbours(std::int32_t particle) const;
  void move_ends();
  void take_through(std::int32_t end, std::int32_t other, const Face& face, Moves& moves) const;
  void take_along(Moves& moves) const;
  void put_back();
  const Vec3& at(std::int32_t particle) const { return x_[std::size_t(particle)]; }
  double inverse_mass(std::int32_t particle) const;
  const Sheet& sheet_of(std::int32_t particle) const;

  std::vector<Sheet> sheets_;
  bool due_;
  int since_ = 0;            // frames in which something crossed, without a break
  bool came_apart_ = false;  // in one of them all of it did
  std::vector<std::uint8_t> passing_;
  std::vector<std::uint8_t> open_,
      opened_;  // ends of open seams, in this frame and in the one before

  // As found last.
  std::vector<Vec3> x_;  // m
  std::vector<Face> faces_;
  std::vector<std::int32_t> sewn_;  // who stands for each particle
  std::vector<Edge> edges_;
  std::vector<Crossing> crossings_;
  std::vector<std::int32_t> line_;  // of every crossing
  std::vector<End> ends_;
  std::vector<Edge> whole_;               // that do not cross
  std::vector<std::size_t> first_;        // of every particle's neighbours
  std::vector<std::int32_t> neighbours_;  // by whole edges
  // By one line: the part of every particle, or -1, and those that have one.
  std::vector<std::int32_t> part_, reached_;
};

}  // namespace weft::physics
