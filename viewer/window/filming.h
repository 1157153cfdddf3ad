// The film of the window: begins with its first frame, takes what is due, ends with its last.
#pragma once

#include <limits>
#include <optional>

#include "film/film.h"
#include "film/film_request.h"
#include "window/view.h"
#include "window/workspace.h"

namespace weft::viewer {

class Filming {
 public:
  bool on() const { return film_.has_value(); }
  // `width`, `height`: of the view. A scene that is past the first frame starts anew, and plays.
  void start(FilmRequest request, int width, int height, Workspace& workspace);
  void end(Workspace& workspace);
  // After a turn: the picture that is due.
  void turn(Workspace& workspace, View& view);
  // Makes the film whole where the program ends: what went wrong, or "".
  std::string finish();

 private:
  void wait_for_next(Workspace& workspace);

  std::optional<Film> film_;
  std::optional<std::uint64_t> from_start_;  // a new start is on its way from this scene's serial
  double last_ = std::numeric_limits<double>::infinity();      // s, of the simulation
  double waits_at_ = std::numeric_limits<double>::infinity();  // s, the simulation, for the film
};

}  // namespace weft::viewer
