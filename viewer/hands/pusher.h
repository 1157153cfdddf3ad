// Moves what is chosen, a body or a cloth: by dragging, by the handles about it, by keys. What a body was moved
// to becomes part of the scene when it is let go. Rings and square, and all handles of a cloth, change the scene
// at once: where a cloth starts, so that the scene starts anew. Keys carry what is held of all cloths.
#pragma once

#include "edit/parts.h"
#include "hands/gizmo.h"
#include "window/workspace.h"

namespace weft::viewer {

class Pusher {
 public:
  void choose(std::optional<Part> part) { chosen_ = part; }
  const std::optional<Part>& chosen() const { return chosen_; }

  // Takes hold of the handle under the pointer, if there is one.
  bool take_handle(const Workspace& workspace, const Area& area, float x, float y);
  // Takes hold of the body itself, to be moved across the view.
  void take_body(const Workspace& workspace, int body, Vec3f point);
  void drag(Workspace& workspace, const Ray& ray);
  void let_go(Workspace& workspace);

  // A direction in the view (right, up, towards the eye), each -1 … 1, for `seconds`.
  void push(Workspace& workspace, Vec3f direction, double seconds);

  void draw(const Workspace& workspace, const Area& area, ImDrawList& list) const;

 private:
  void follow_scene(const Workspace& workspace);
  bool is(Kind kind) const { return chosen_ && chosen_->kind == kind; }
  bool there(const Workspace& workspace) const;
  Vec3f place(const Workspace& workspace) const;
  Handles handles(const Workspace& workspace) const;
  void take(const Workspace& workspace, Grip grip, Vec3f point);
  Vec3f normal_of(Vec3f forward) const;
  Vec3f shift(Vec3f to) const;
  void move_body(Workspace& workspace, Vec3f to);
  void reshape(Workspace& workspace, Vec3f to);
  void carry(Workspace& workspace, Vec3f velocity);

  std::optional<Part> chosen_;
  std::string scene_;  // that the choice belongs to
  Grip held_;
  Vec3f grip_{};         // where it was taken
  Scene before_;         // the scene then
  bool joined_ = false;  // the scene has changed since
  Vec3f start_{};        // the part's place then
  Vec3f now_{};          // a body's place as last asked for; else the pointer's
  bool moved_ = false, pushing_ = false, carrying_ = false;
};

}  // namespace weft::viewer
