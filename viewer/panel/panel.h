// All controls around and over the picture. Each part is a file of its own.
#pragma once

#include "film/film_request.h"
#include "hands/hands.h"
#include "panel/gallery.h"
#include "panel/history.h"
#include "panel/mesh_form.h"
#include "panel/parameters.h"
#include "window/keys.h"
#include "window/workspace.h"

namespace weft::viewer {

// A picture of the view as a file.
struct PictureRequest {
  int width = 0, height = 0;  // pixels; 0: as the view
  int samples = 8;            // of a pixel
};

// What a person asks for that the window itself must do.
struct Requests {
  std::optional<PictureRequest> picture;
  std::optional<FilmRequest> film;  // begun, or ended
  std::optional<Kind> newest;       // the newest of the kind is to be moved
  bool gallery = false;             // to be opened
  bool mesh = false;                // a file of a mesh is to be added
};

// What a person has put into the forms of pictures and exports.
struct FileForms {
  PictureRequest picture{1920, 1080, 8};
  int format = 0;      // of animation_extensions()
  std::string path;    // of the export
  bool named = false;  // the path was typed
  FrameRange frames;   // of the export
  bool film_as_view = true;
  FilmRequest film{1920, 1080, {}};
};

class Panel {
 public:
  explicit Panel(const Keys& keys) : keys_(keys) {}

  // The room that is left for the picture, in the panel's units.
  Area picture_area() const;
  // The share of its height, about the middle, that tools and transport leave free.
  float clear_share() const;
  void draw(Workspace& workspace, Hands& hands, Requests& requests);

  bool visible = true;
  bool help = false;
  bool filming = false;
  Gallery gallery;
  MeshForm mesh_form;
  History history;

 private:
  bool has_side() const;
  void draw_side(Workspace& workspace, Requests& requests);

  const Keys& keys_;
  Parameters parameters_;
  FileForms forms_;
  std::string path_;     // as it is typed
  double opened_ = -1;   // s
  bool played_ = false;  // a hand has done something
};

// The parts.
void draw_scenes(Workspace& workspace, Requests& requests, std::string& path);
void draw_files(Workspace& workspace, Requests& requests, FileForms& forms, bool filming);
// Buttons that add cloths and bodies.
void draw_parts(Workspace& workspace, Requests& requests);
void draw_fabrics(Workspace& workspace);
void draw_spring_cloth(Workspace& workspace);
// What of it is looked for.
void draw_course_cloth(Workspace& workspace, const Parameters& parameters);
void draw_looks(Workspace& workspace);
void draw_machine(Workspace& workspace);  // threads, instruction set
// Keys [t, x, …] of a path, or of an angle over time; a first one is put at `now` [s] and `start`. True when
// they have changed. `about`: what they are, with units.
bool draw_path(const std::string& name, const std::string& pointer, text::Json& keys, double now,
               const std::vector<double>& start, const char* about);
void draw_measures(const Workspace& workspace, const History& history);
void draw_transport(Workspace& workspace, const Area& area, const Keys& keys);
void draw_tools(Hands& hands, const Area& area, const Keys& keys);
void draw_corner(const Workspace& workspace, const History& history, const Area& area);
void draw_legend(const Workspace& workspace, const Area& area);
// `seconds`: since the window opened, or far more once somebody has pulled.
void draw_hints(const Area& area, double seconds);
void draw_messages(Messages& messages, const Area& area);
void draw_help(bool& open, const Keys& keys);

// Begins a small window over the picture; end with ImGui::End().
bool begin_overlay(const char* name, float x, float y, float pivot_x, float pivot_y);

}  // namespace weft::viewer
