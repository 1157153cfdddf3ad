// OpenGL objects that delete themselves. All need the context in which they were made to be
// current.
#pragma once

#include <glad/gl.h>

#include <utility>

namespace weft::viewer {

template <auto& Delete>
class GlObject {
 public:
  GlObject() = default;
  explicit GlObject(GLuint id) : id_(id) {}
  ~GlObject() { reset(); }
  GlObject(GlObject&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
  GlObject& operator=(GlObject&& other) noexcept {
    if (this != &other) {
      reset();
      id_ = std::exchange(other.id_, 0);
    }
    return *this;
  }
  GlObject(const GlObject&) = delete;
  GlObject& operator=(const GlObject&) = delete;

  GLuint id() const { return id_; }
  explicit operator bool() const { return id_ != 0; }

 private:
  void reset() {
    if (id_ != 0) Delete(id_);
    id_ = 0;
  }

  GLuint id_ = 0;
};

inline void delete_buffer(GLuint id) {
  glDeleteBuffers(1, &id);
}
inline void delete_vertex_array(GLuint id) {
  glDeleteVertexArrays(1, &id);
}
inline void delete_texture(GLuint id) {
  glDeleteTextures(1, &id);
}
inline void delete_framebuffer(GLuint id) {
  glDeleteFramebuffers(1, &id);
}
inline void delete_renderbuffer(GLuint id) {
  glDeleteRenderbuffers(1, &id);
}
inline void delete_program(GLuint id) {
  glDeleteProgram(id);
}
inline void delete_shader(GLuint id) {
  glDeleteShader(id);
}

using Buffer = GlObject<delete_buffer>;
using VertexArray = GlObject<delete_vertex_array>;
using Texture = GlObject<delete_texture>;
using Framebuffer = GlObject<delete_framebuffer>;
using Renderbuffer = GlObject<delete_renderbuffer>;
using ProgramObject = GlObject<delete_program>;
using ShaderObject = GlObject<delete_shader>;

template <class Object, class Generate>
Object generate(Generate generate_one) {
  GLuint id = 0;
  generate_one(1, &id);
  return Object(id);
}

inline Buffer make_buffer() {
  return generate<Buffer>(glGenBuffers);
}
inline VertexArray make_vertex_array() {
  return generate<VertexArray>(glGenVertexArrays);
}
inline Texture make_texture() {
  return generate<Texture>(glGenTextures);
}
inline Framebuffer make_framebuffer() {
  return generate<Framebuffer>(glGenFramebuffers);
}
inline Renderbuffer make_renderbuffer() {
  return generate<Renderbuffer>(glGenRenderbuffers);
}

}  // namespace weft::viewer
