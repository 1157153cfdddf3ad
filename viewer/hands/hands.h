// The pointer's work in the picture: the camera, and five tools.
#pragma once

#include <optional>
#include <vector>

#include "hands/cut_stroke.h"
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

  // Takes up the newest cloth or body, to be moved.
  void choose_newest(const Workspace& workspace, Kind kind);

  bool busy() const { return drag_ != Drag::none; }
  // Whether a hand pulls that nobody holds any more.
  bool waits() const { return waiting_.has_value(); }

  Pusher pusher;  // moves what is chosen

 private:
  enum class Drag { none, orbit, pan, cloth, body, cut, lasso };

  static Vec3f pivot(const Workspace& workspace, const Area& area, const Pointer& pointer);
  void press(Workspace& workspace, const Area& area, const Pointer& pointer);
  void drag(Workspace& workspace, const Area& area, const Pointer& pointer);
  void release(Workspace& workspace, const Area& area);
  void grab(Workspace& workspace, const Ray& ray);
  void cut(Workspace& workspace);
  void cut_meshes(Workspace& workspace, const Area& area, const Ray& to) const;
  // Pins these particles of the cloths, or lets them go where all of them are pinned.
  void toggle_pins(Workspace& workspace, const std::vector<std::vector<int>>& particles) const;
  void take_lasso(Workspace& workspace, const Area& area) const;
  void shoot(Workspace& workspace, const Ray& ray) const;
  void let_go(Workspace& workspace);
  void watch_waiting(Workspace& workspace);

  Drag drag_ = Drag::none;
  bool panning_ = false;
  std::optional<Vec3f> pivot_;  // of the orbit that goes on
  ClothHit held_;
  Vec3f target_;
  // A hand that was let go in a paused scene goes on pulling when the scene does, until the point is there.
  struct Waiting {
    std::string scene;
    std::int64_t frame = 0;
    double since = 0;  // s, of the simulation
  };
  std::optional<Waiting> waiting_;
  CutStroke stroke_;
  std::vector<std::vector<CutLine>> cuts_;  // of the cloths, before the stroke
  bool joined_ = false;                     // the stroke has changed the scene already
  std::vector<std::array<float, 2>> lasso_;
};

}  // namespace weft::viewer
