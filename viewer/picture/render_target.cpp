// Framebuffers.
#include "picture/render_target.h"

#include <algorithm>

#include "failure.h"

namespace weft::viewer {

namespace {

void storage(const Renderbuffer& buffer, int samples, GLenum format, int width, int height) {
  glBindRenderbuffer(GL_RENDERBUFFER, buffer.id());
  glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, format, width, height);
}

}  // namespace

RenderTarget::RenderTarget(int width, int height, int samples)
    : width_(width),
      height_(height),
      several_(samples > 1),
      samples_color_(make_renderbuffer()),
      samples_depth_(make_renderbuffer()),
      color_(make_renderbuffer()),
      samples_(make_framebuffer()),
      result_(make_framebuffer()) {
  GLint most = 1;
  glGetIntegerv(GL_MAX_SAMPLES, &most);
  samples = several_ ? std::min(samples, static_cast<int>(most)) : 0;
  storage(samples_depth_, samples, GL_DEPTH_COMPONENT24, width, height);
  storage(color_, 0, GL_SRGB8_ALPHA8, width, height);
  const auto attach = [](const Framebuffer& to, GLenum what, const Renderbuffer& buffer) {
    glBindFramebuffer(GL_FRAMEBUFFER, to.id());
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, what, GL_RENDERBUFFER, buffer.id());
  };
  bool good = true;
  if (several_) {
    storage(samples_color_, samples, GL_SRGB8_ALPHA8, width, height);
    attach(samples_, GL_COLOR_ATTACHMENT0, samples_color_);
    attach(samples_, GL_DEPTH_ATTACHMENT, samples_depth_);
    good = glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
  } else {
    attach(result_, GL_DEPTH_ATTACHMENT, samples_depth_);
  }
  attach(result_, GL_COLOR_ATTACHMENT0, color_);
  if (!good || glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw Failure(kNoGraphics, "OpenGL cannot draw a picture of " + std::to_string(width) + "x" +
                                   std::to_string(height) + " pixels");
}

void RenderTarget::begin() const {
  glBindFramebuffer(GL_FRAMEBUFFER, several_ ? samples_.id() : result_.id());
  glViewport(0, 0, width_, height_);
  glEnable(GL_FRAMEBUFFER_SRGB);
  glEnable(GL_MULTISAMPLE);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

void RenderTarget::resolve() const {
  if (several_) {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, samples_.id());
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, result_.id());
    glBlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT,
                      GL_NEAREST);
  }
  glBindFramebuffer(GL_FRAMEBUFFER, result_.id());
  glDisable(GL_FRAMEBUFFER_SRGB);  // the panel's colours are sRGB already
}

void RenderTarget::begin_over() const {
  glBindFramebuffer(GL_FRAMEBUFFER, result_.id());
  glViewport(0, 0, width_, height_);
  glEnable(GL_FRAMEBUFFER_SRGB);
}

void RenderTarget::copy_depth(GLuint framebuffer) const {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, several_ ? samples_.id() : result_.id());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
  glBlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_DEPTH_BUFFER_BIT, GL_NEAREST);
}

void RenderTarget::show(GLuint framebuffer, int x, int y, int width, int height) const {
  const bool same = width == width_ && height == height_;
  glBindFramebuffer(GL_READ_FRAMEBUFFER, result_.id());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
  glBlitFramebuffer(0, 0, width_, height_, x, y, x + width, y + height, GL_COLOR_BUFFER_BIT,
                    same ? GL_NEAREST : GL_LINEAR);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
}

Picture RenderTarget::read() const {
  Picture picture{width_, height_, {}};
  const auto row = static_cast<std::size_t>(width_) * 3;
  std::vector<std::uint8_t> upward(row * static_cast<std::size_t>(height_));
  glBindFramebuffer(GL_READ_FRAMEBUFFER, result_.id());
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width_, height_, GL_RGB, GL_UNSIGNED_BYTE, upward.data());
  for (auto j = static_cast<std::size_t>(height_); j-- > 0;)
    picture.rgb.insert(picture.rgb.end(), upward.begin() + static_cast<std::ptrdiff_t>(j * row),
                       upward.begin() + static_cast<std::ptrdiff_t>((j + 1) * row));
  return picture;
}

ShadowMap::ShadowMap(int size)
    : size_(size), depth_(make_texture()), framebuffer_(make_framebuffer()) {
  glBindTexture(GL_TEXTURE_2D, depth_.id());
  glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT24, size, size, 0, GL_DEPTH_COMPONENT, GL_FLOAT,
               nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth_.id(), 0);
  glDrawBuffer(GL_NONE);
  glReadBuffer(GL_NONE);
}

void ShadowMap::begin() const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
  glViewport(0, 0, size_, size_);
  glClear(GL_DEPTH_BUFFER_BIT);
}

}  // namespace weft::viewer
