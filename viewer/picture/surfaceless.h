// An OpenGL context without any display or window: EGL surfaceless, as Mesa offers it.
#pragma once

namespace weft::viewer {

class SurfacelessContext {
 public:
  // Makes the context current and loads OpenGL. Throws Failure when there is no OpenGL 3.3.
  SurfacelessContext();
  ~SurfacelessContext();
  SurfacelessContext(const SurfacelessContext&) = delete;
  SurfacelessContext& operator=(const SurfacelessContext&) = delete;

 private:
  void* display_ = nullptr;
  void* context_ = nullptr;
};

}  // namespace weft::viewer
