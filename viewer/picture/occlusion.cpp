// Depths, then occlusion, then the picture.
#include "picture/occlusion.h"

#include <cmath>

namespace weft::viewer {

namespace {

constexpr GLuint kDepthUnit = 8, kOpenUnit = 9;  // see Shader

Texture image(GLenum format, GLenum parts, GLenum type, GLint filter, int width, int height) {
  Texture texture = make_texture();
  glBindTexture(GL_TEXTURE_2D, texture.id());
  glTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(format), width, height, 0, parts, type,
               nullptr);
  for (const GLenum which : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    glTexParameteri(GL_TEXTURE_2D, which, filter);
  for (const GLenum which : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
    glTexParameteri(GL_TEXTURE_2D, which, GL_CLAMP_TO_EDGE);
  return texture;
}

}  // namespace

void Occlusion::size(int width, int height) {
  if (width == width_ && height == height_) return;
  width_ = width, height_ = height;
  glActiveTexture(GL_TEXTURE0 + kDepthUnit);
  depth_ =
      image(GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, GL_NEAREST, width, height);
  open_ = image(GL_R8, GL_RED, GL_UNSIGNED_BYTE, GL_LINEAR, (width + 1) / 2, (height + 1) / 2);
  glActiveTexture(GL_TEXTURE0);
  depth_target_ = make_framebuffer();
  glBindFramebuffer(GL_FRAMEBUFFER, depth_target_.id());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth_.id(), 0);
  glDrawBuffer(GL_NONE);
  glReadBuffer(GL_NONE);
  open_target_ = make_framebuffer();
  glBindFramebuffer(GL_FRAMEBUFFER, open_target_.id());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, open_.id(), 0);
  if (!nothing_) nothing_ = make_vertex_array();
}

void Occlusion::apply(const RenderTarget& target, const Shader& occlusion, const Shader& occlude,
                      const Camera& camera, float reach) {
  const int width = target.width(), height = target.height();
  size(width, height);
  target.copy_depth(depth_target_.id());
  const float aspect = static_cast<float>(width) / static_cast<float>(height);
  const Mat4 lens = camera.projection(aspect);
  const float t = std::tan(camera.fov() / 2);
  const std::pair<GLuint, GLuint> textures[] = {{kDepthUnit, depth_.id()}, {kOpenUnit, open_.id()}};
  for (const auto& [unit, texture] : textures) {
    glActiveTexture(GL_TEXTURE0 + unit);
    glBindTexture(GL_TEXTURE_2D, texture);
  }
  glActiveTexture(GL_TEXTURE0);
  glDisable(GL_DEPTH_TEST);
  glBindVertexArray(nothing_.id());
  const auto draw = [&](const Shader& shader) {
    shader.use();
    shader.set("u_lens", {lens.m[10], lens.m[14], t * aspect}, t);
    shader.set("u_reach", reach);
    glDrawArrays(GL_TRIANGLES, 0, 3);
  };
  glBindFramebuffer(GL_FRAMEBUFFER, open_target_.id());
  glViewport(0, 0, (width + 1) / 2, (height + 1) / 2);
  draw(occlusion);
  target.begin_over();
  glEnable(GL_BLEND);
  glBlendFunc(GL_ZERO, GL_SRC_COLOR);
  draw(occlude);
  glDisable(GL_BLEND);
  glEnable(GL_DEPTH_TEST);
  glDisable(GL_FRAMEBUFFER_SRGB);
}

}  // namespace weft::viewer
