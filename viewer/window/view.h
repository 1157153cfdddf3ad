// The picture in the window. It is drawn anew only when something in it has changed, and coarser
// while drawing is slow and things move, so that the panel stays quick on any machine.
#pragma once

#include <optional>
#include <string>

#include "hands/pick.h"
#include "picture/renderer.h"
#include "window/workspace.h"

namespace weft::viewer {

class View {
 public:
  explicit View(const PictureFiles& pictures);

  // Draws what is new, and copies the picture into the window: x, y its lower left corner [pixels].
  void draw(Workspace& workspace, int x, int y, int width, int height);
  // The whole picture in full quality; `samples`: of a pixel.
  Picture picture(const Workspace& workspace, int width, int height, int samples = 8);

  // Looks after the shaders' files and the pictures asked for.
  void reload(Workspace& workspace);

  bool drawn() const { return drawn_; }  // whether the last draw() drew anew
  bool coarse() const { return drawn_coarseness_ > 0; }
  // Whether it has every pixel and vertex, if not every sample.
  bool whole() const { return drawn_coarseness_ <= 1; }
  double own_ms() const { return renderer_.upload_ms(); }  // normals and upload of the last state
  // How long the window took for a frame with a new picture.
  void took(double ms);

 private:
  struct Seen {
    std::uint64_t scene = 0, change = 0;
    std::int64_t frame = -1;
    const Look* look = nullptr;
    LookSettings settings;
    std::array<float, 16> view{}, projection{};
    int width = 0, height = 0;
    friend bool operator==(const Seen&, const Seen&) = default;
  };

  Renderer renderer_;
  PictureFiles pictures_;
  std::optional<RenderTarget> target_;
  Seen seen_;
  bool fine(const LookSettings& settings) const;

  bool software_;
  bool drawn_ = false, stale_ = true, was_paused_ = false;
  int coarseness_ = 0, drawn_coarseness_ = 0;  // 0: in full
  double smoothed_ms_ = 0, last_change_ = 0, next_reload_ = 0;
};

}  // namespace weft::viewer
