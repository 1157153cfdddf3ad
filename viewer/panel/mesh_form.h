// Asks what the mesh of a file is to be in the scene, a cloth or a body, and where.
#pragma once

#include <deque>
#include <string>

#include "edit/parts.h"
#include "weft/mesh.h"
#include "window/workspace.h"

namespace weft::viewer {

struct Requests;

class MeshForm {
 public:
  // Opens for a file, or "" for one yet to be named; one after the other.
  void ask(const std::string& path) { waiting_.push_back(path); }
  void draw(Workspace& workspace, Requests& requests);

 private:
  void take(const std::string& path, const Workspace& workspace);
  void draw_path(const Workspace& workspace);
  void draw_mesh();
  MeshSource placed(const Workspace& workspace) const;

  std::deque<std::string> waiting_;
  std::string path_;                 // as it is typed
  std::string taken_;                // the one that was read
  std::vector<std::string> beside_;  // meshes in the same folder
  MeshFile file_;
  Vec3 low_{}, high_{};      // of its vertices, in its units
  double scale_ = 1;         // m for each unit of the file
  bool as_in_file_ = false;  // stands where the file has it, else where the camera looks
};

}  // namespace weft::viewer
