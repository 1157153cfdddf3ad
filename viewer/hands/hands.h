// The pointer's work in the picture: the camera, and five tools.
#pragma once

#include <optional>
#include <vector>

#include "hands/pick.h"
#include "hands/pusher.h"
#include "window/workspace.h"

struct ImDrawList;

namespace weft::viewer {

enum class Tool { hand, pin, cut, move, ball };

struct Pointer {
  float x = 0, y = 0;    // in the panel's units
  float dx = 0, dy = 0;  // since the last frame
  float wheel = 0;
  bool left = false, right = false, middle = false;  // down
  bool pressed = false, released = false;            // the left one, in this frame
  bool inside = false;                               // over the picture, not over the panel
  bool ctrl = false, shift = false, alt = false;
};

class Hands {
 public:
  Tool tool = Tool::hand;

  void update(Workspace& workspace, const Area& area, const Pointer& pointer);
  // Marks over the picture: pins, what is held, the stroke, arrows of the chosen body.
  void draw(const Workspace& workspace, const Area& area, ImDrawList& list) const;

  bool busy() const { return drag_ != Drag::none; }

  Pusher pusher;  // moves what is chosen

 private:
  enum class Drag { none, orbit, pan, cloth, body, cut };

  void press(Workspace& workspace, const Area& area, const Pointer& pointer);
  void drag(Workspace& workspace, const Area& area, const Pointer& pointer);
  void release(Workspace& workspace);
  void grab(Workspace& workspace, const Ray& ray);
  void cut(Workspace& workspace);
  void toggle_pin(Workspace& workspace, const ClothHit& hit) const;
  void shoot(Workspace& workspace, const Ray& ray) const;

  Drag drag_ = Drag::none;
  bool panning_ = false;
  ClothHit held_;
  Vec3f target_;
  struct StrokePoint {
    float x, y;
    std::optional<ClothHit> hit;
  };
  std::vector<StrokePoint> stroke_;
};

}  // namespace weft::viewer
