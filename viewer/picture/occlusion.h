// Ambient occlusion: folds and what rests on something grow darker where the sky does not reach. From the depths
// of a picture that is drawn, onto the picture, at half its resolution.
#pragma once

#include "picture/camera.h"
#include "picture/gl.h"
#include "picture/render_target.h"
#include "picture/shader.h"

namespace weft::viewer {

class Occlusion {
 public:
  // Darkens what the target shows. `reach` [m]: what is farther away hides nothing.
  void apply(const RenderTarget& target, const Shader& occlusion, const Shader& occlude,
             const Camera& camera, float reach);

 private:
  void size(int width, int height);

  int width_ = 0, height_ = 0;
  Texture depth_, open_;
  Framebuffer depth_target_, open_target_;
  VertexArray nothing_;
};

}  // namespace weft::viewer
