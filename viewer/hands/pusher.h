// Moves what is chosen, a collider or all that is held of the cloths: by dragging, by the arrows of
// its gizmo, by keys. What a collider was moved to becomes part of the scene when it is let go.
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

  // Takes hold of an arrow of the gizmo under the pointer, if there is one.
  bool take_arrow(const Workspace& workspace, const Area& area, float x, float y);
  // Takes hold of the body itself, to be moved across the view.
  void take_body(const Workspace& workspace, int body, Vec3f point);
  void drag(Workspace& workspace, const Ray& ray);
  void let_go(Workspace& workspace);

  // A direction in the view (right, up, towards the eye), each -1 … 1, for `seconds`.
  void push(Workspace& workspace, Vec3f direction, double seconds);

  void draw(const Workspace& workspace, const Area& area, ImDrawList& list) const;

 private:
  void follow_scene(const Workspace& workspace);
  bool has_body(const Workspace& workspace) const;
  Vec3f place(const Workspace& workspace) const;
  void move_body(Workspace& workspace, Vec3f to);
  void carry(Workspace& workspace, Vec3f velocity);

  int chosen_ = kNothing;
  std::string scene_;  // that the choice belongs to
  Vec3f axis_{};       // of the arrow that is held; zero: across the view
  Vec3f grip_{};       // where it was taken
  Vec3f start_{};      // the body's place then
  Vec3f now_{};        // its place as last asked for
  bool moved_ = false, pushing_ = false, carrying_ = false;
};

}  // namespace weft::viewer
