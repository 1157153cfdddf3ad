// Where a picture is drawn: an off-screen image, with several samples per pixel that resolve() makes one.
// Colours are stored as sRGB.
#pragma once

#include "picture/gl.h"
#include "picture/images.h"

namespace weft::viewer {

class RenderTarget {
 public:
  // Throws Failure when the card cannot hold it.
  RenderTarget(int width, int height, int samples);

  int width() const { return width_; }
  int height() const { return height_; }

  void begin() const;    // draws go here from now on
  void resolve() const;  // joins the samples; further draws (the panel) go onto the result
  // Draws go onto the result from now on, without depths.
  void begin_over() const;
  // Copies the depths into a framebuffer of the same size, of 24 bits and one sample.
  void copy_depth(GLuint framebuffer) const;
  // Copies the result there, stretched to a rectangle with its lower left corner at (x, y).
  void show(GLuint framebuffer, int x, int y, int width, int height) const;
  Picture read() const;

 private:
  int width_, height_;
  bool several_;  // samples
  Renderbuffer samples_color_, samples_depth_, color_;
  Framebuffer samples_, result_;
};

// An image of depths as seen from the light.
class ShadowMap {
 public:
  explicit ShadowMap(int size);
  void begin() const;
  int size() const { return size_; }
  GLuint texture() const { return depth_.id(); }

 private:
  int size_;
  Texture depth_;
  Framebuffer framebuffer_;
};

}  // namespace weft::viewer
