// When to draw, and how finely.
#include "window/view.h"

#include <numeric>

namespace weft::viewer {

namespace {

constexpr struct {
  int samples;
  float scale;
  int shadow_softness, shadow_size, detail, tessellation;
} kQuality[] = {{4, 1.0f, 3, 2048, 200, 128},  // llvmpipe draws one sample or four: two cost four
                {1, 1.0f, 2, 1024, 200, 64},
                {1, 0.8f, 2, 1024, 120, 64},
                {1, 0.6f, 1, 1024, 70, 48},
                {1, 0.45f, 1, 512, 40, 32}};
constexpr int kCoarsest = std::size(kQuality) - 1;
constexpr int kSoftest = 4;               // samples along a side of a fine shadow's edge
constexpr double kSlow = 28, kQuick = 9;  // ms a frame: coarser beyond, finer below
constexpr double kRest = 0.25;  // s without a change in a paused scene, then the full picture

// Drawn by the processor.
bool is_software() {
  const auto* name = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  const std::string renderer = name ? name : "";
  return renderer.find("llvmpipe") != std::string::npos ||
         renderer.find("softpipe") != std::string::npos;
}

}  // namespace

View::View(const PictureFiles& pictures)
    : renderer_(pictures),
      pictures_(pictures),
      software_(is_software()),
      coarseness_(software_ ? 3 : 0) {}

bool View::fine(const LookSettings& settings) const {
  return settings.quality == Quality::fine ||
         (settings.quality == Quality::automatic && !software_);
}

void View::reload(Workspace& workspace) {
  if (workspace.now() < next_reload_) return;
  next_reload_ = workspace.now() + 0.3;
  stale_ = renderer_.reload_changed() || stale_;
  if (!(workspace.pictures == pictures_)) {
    pictures_ = workspace.pictures;
    renderer_.set_pictures(pictures_);
    stale_ = true;
  }
  const std::vector<std::string> problems = renderer_.problems();
  workspace.messages.fault("looks",
                           std::accumulate(problems.begin(), problems.end(), std::string(),
                                           [](const std::string& all, const std::string& one) {
                                             return all + (all.empty() ? "" : "\n") + one;
                                           }));
}

void View::draw(Workspace& workspace, int x, int y, int width, int height) {
  const FrameData& frame_data = workspace.frame_data();
  const Camera& camera = workspace.camera;
  const float aspect = static_cast<float>(width) / static_cast<float>(height);
  const Seen now{frame_data.scene_serial,
                 frame_data.change,
                 frame_data.frame,
                 workspace.look,
                 workspace.settings,
                 camera.view().m,
                 camera.projection(aspect).m,
                 width,
                 height};
  const bool changed = stale_ || !(now == seen_);
  if (changed) last_change_ = workspace.now();
  // Who pauses wants to see it at once; who turns a paused scene, when it stands still. The first picture has what
  // a pause has, so that drivers have compiled what it needs.
  const bool paused = workspace.telemetry().paused;
  const bool at_once = !target_ || (paused && !was_paused_);
  const bool rests = at_once || (paused && workspace.now() - last_change_ > kRest);
  was_paused_ = paused;
  const bool quick = workspace.settings.quality == Quality::quick || (at_once && software_);
  const int coarseness = rests ? (quick ? 1 : 0) : coarseness_;
  drawn_ = changed || (rests && drawn_coarseness_ > coarseness);
  if (drawn_) {
    const auto& quality = kQuality[coarseness];
    const int w = std::max(16, static_cast<int>(static_cast<float>(width) * quality.scale));
    const int h = std::max(16, static_cast<int>(static_cast<float>(height) * quality.scale));
    if (!target_ || target_->width() != w || target_->height() != h ||
        drawn_coarseness_ != coarseness)
      target_.emplace(w, h, quality.samples);
    LookSettings settings = workspace.settings;
    settings.shadow_softness = quality.shadow_softness;
    settings.fine = coarseness == 0 && fine(settings);
    if (settings.fine) settings.shadow_softness = kSoftest;
    settings.shadow_size = quality.shadow_size;
    settings.detail = quality.detail;
    settings.tessellation = std::min(settings.tessellation, quality.tessellation);
    if (coarseness > 0) settings.refinement = 0;
    renderer_.draw(frame_data, workspace.setting(), *workspace.look, settings, camera, *target_);
    seen_ = now;
    stale_ = false;
    drawn_coarseness_ = coarseness;
  }
  target_->show(0, x, y, width, height);
}

void View::took(double ms) {
  if (!drawn_ || (drawn_coarseness_ == 0 && coarseness_ > 0)) return;
  smoothed_ms_ += (ms > 3 * kSlow ? 0.6 : 0.15) * (ms - smoothed_ms_);
  if (smoothed_ms_ > kSlow && coarseness_ < kCoarsest) {
    ++coarseness_;
    smoothed_ms_ = (kSlow + kQuick) / 2;
  } else if (smoothed_ms_ < kQuick && coarseness_ > 0) {
    --coarseness_;
    smoothed_ms_ = (kSlow + kQuick) / 2;
  }
}

Picture View::picture(const Workspace& workspace, int width, int height, int samples) {
  const RenderTarget target(width, height, samples);
  LookSettings settings = workspace.settings;
  settings.fine = fine(settings);
  if (settings.fine) settings.shadow_softness = kSoftest;
  renderer_.draw(workspace.frame_data(), workspace.setting(), *workspace.look, settings,
                 workspace.camera, target);
  return target.read();
}

}  // namespace weft::viewer
