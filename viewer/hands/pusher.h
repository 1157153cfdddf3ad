// Moves what is chosen, a collider or all that is held of the cloths: by dragging, by the arrows of
// its gizmo, by keys. What a collider was moved to becomes part of the scene when it is let go. The rings of the
// gizmo turn a collider, and its square sizes it: changes of the scene at once.
#pragma once

#include "hands/pick.h"
#include "window/workspace.h"

struct ImDrawList;

namespace weft::viewer {

class Pusher {
 public:
  // A collider, or kCloth.
  static constexpr int kCloth = -1, kNothing = -2;
  void choose(int body) { chosen_ = body; }
  int chosen() const { return chosen_; }

  // Takes hold of the arrow, the ring or the square of the gizmo under the pointer, if there is one.
  bool take_gizmo(const Workspace& workspace, const Area& area, float x, float y);
  // Takes hold of the body itself, to be moved across the view.
  void take_body(const Workspace& workspace, int body, Vec3f point);
  void drag(Workspace& workspace, const Ray& ray);
  void let_go(Workspace& workspace);

  // A direction in the view (right, up, towards the eye), each -1 … 1, for `seconds`.
  void push(Workspace& workspace, Vec3f direction, double seconds);

  void draw(const Workspace& workspace, const Area& area, ImDrawList& list) const;

 private:
  enum class Grip { across, arrow, ring, square };
  using Outline = std::array<ScreenPoint, 49>;

  void follow_scene(const Workspace& workspace);
  bool has_body(const Workspace& workspace) const;
  Vec3f place(const Workspace& workspace) const;
  bool take(const Workspace& workspace, Grip grip, std::size_t axis, const Ray& ray);
  Vec3f normal_of(Vec3f forward) const;
  // The gizmo on the screen: the ring about an axis, and the middle of the square.
  static Outline ring(const Workspace& workspace, const Area& area, Vec3f at, std::size_t axis);
  static ScreenPoint square(const Workspace& workspace, const Area& area, Vec3f at);
  void move_body(Workspace& workspace, Vec3f to);
  void reshape(Workspace& workspace, Vec3f to);
  void carry(Workspace& workspace, Vec3f velocity);

  int chosen_ = kNothing;
  std::string scene_;  // that the choice belongs to
  Grip held_ = Grip::across;
  std::size_t axis_ = 0;  // of the arrow or ring that is held
  Vec3f grip_{};          // where it was taken
  Shape shape_;           // of the body then
  bool reshaped_ = false;
  Vec3f start_{};  // the body's place then
  Vec3f now_{};    // its place as last asked for; while it is turned or sized, the pointer's
  bool moved_ = false, pushing_ = false, carrying_ = false;
};

}  // namespace weft::viewer
