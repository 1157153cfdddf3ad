// The shipped scenes as pictures over the whole window; a click opens one.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "picture/gl.h"
#include "window/workspace.h"

namespace weft::viewer {

class Gallery {
 public:
  bool open = false;
  void draw(Workspace& workspace);

 private:
  void tile(Workspace& workspace, const ShippedScene& scene);
  // Read once; empty where there is none.
  const Texture& picture_of(const std::string& scene);

  std::map<std::string, Texture> pictures_;  // by scene
};

}  // namespace weft::viewer
