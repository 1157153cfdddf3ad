// Pictures of the view into a film.
#include "window/filming.h"

#include "failure.h"

namespace weft::viewer {

namespace {

constexpr double kEndless = std::numeric_limits<double>::infinity();

}  // namespace

void Filming::start(FilmRequest request, int width, int height, Workspace& workspace) {
  const FrameData& now = workspace.frame_data();
  const double frame = workspace.document().scene().time.frame;
  const FrameRange& range = request.range;
  if (request.width > 0) width = request.width, height = request.height;
  try {
    film_.emplace(workspace.document().name(), workspace.record(), width & ~1, height & ~1,
                  range.endless ? now.time : range.first * frame, !range.endless);
  } catch (const Failure& failure) {
    workspace.messages.warn("No film: " + std::string(failure.what()), workspace.now());
    return;
  }
  last_ = range.endless ? kEndless : range.last * frame;
  wait_for_next(workspace);
  from_start_.reset();
  if (!range.endless && now.frame > range.first) {
    from_start_ = now.scene_serial;
    workspace.reset();
  }
  if (!range.endless) workspace.play(true);
  workspace.messages.tell(
      "The film goes to " + full_path(film_->path()) +
          (range.endless ? " until you end it" : " up to frame " + std::to_string(range.last)),
      workspace.now());
}

void Filming::end(Workspace& workspace) {
  try {
    film_->finish();
    workspace.messages.tell("Film saved to " + full_path(film_->path()), workspace.now());
  } catch (const Failure& failure) {
    workspace.messages.warn("No film: " + std::string(failure.what()), workspace.now());
  }
  film_.reset();
}

void Filming::turn(Workspace& workspace, View& view) {
  const FrameData& now = workspace.frame_data();
  if (from_start_ && now.scene_serial != *from_start_) from_start_.reset();
  if (film_ && !from_start_) {
    const int due = film_->due(now.time);
    try {
      if (due > 0) film_->add(view.picture(workspace, film_->width(), film_->height()), due);
      constexpr double kRounding = 1e-6;  // s
      if (film_->next() > last_ + kRounding) end(workspace);
    } catch (const Failure& failure) {
      workspace.messages.warn("The film ends: " + std::string(failure.what()), workspace.now());
      film_.reset();
    }
  }
  wait_for_next(workspace);
}

// Each picture is of a moment of its own, however slowly they are drawn.
void Filming::wait_for_next(Workspace& workspace) {
  const double next = film_ ? film_->next() : kEndless;
  if (next == waits_at_) return;
  waits_at_ = next;
  workspace.wait_at(next);
}

std::string Filming::finish() {
  std::string problem;
  try {
    if (film_) film_->finish();
  } catch (const Failure& failure) {
    problem = failure.what();
  }
  film_.reset();
  return problem;
}

}  // namespace weft::viewer
