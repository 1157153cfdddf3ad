// The program without a window: simulate, draw, write.
#include "headless.h"

#include <algorithm>
#include <iostream>
#include <numbers>

#include "clashes.h"
#include "edit/document.h"
#include "failure.h"
#include "picture/surfaceless.h"
#include "weft/interrupt.h"
#include "weft/takeover.h"

namespace weft::viewer {

std::string scene_name(const Arguments& arguments) {
  if (!arguments.scene.empty()) return arguments.scene;
  const std::vector<ShippedScene> shipped = shipped_scenes();
  if (shipped.empty()) throw Failure(kBadScene, "no scene is named and none is shipped here");
  return shipped.front().path;
}

SceneFile load_scene(const Arguments& arguments) {
  const std::string name = scene_name(arguments);
  SceneFile file = read_scene(name, arguments.overrides);
  if (file.faults.empty()) return file;
  throw Failure(kBadScene, fault_lines(file.path.empty() ? name : file.path, file.faults));
}

Sight sight_of(const Arguments& arguments, const Scene& scene) {
  return {arguments.azimuth.value_or(scene.camera.azimuth),
          arguments.elevation.value_or(scene.camera.elevation),
          arguments.zoom.value_or(scene.camera.zoom)};
}

void aim(const Sight& sight, const Bounds& bounds, float aspect, float clear, Camera& camera) {
  constexpr double degree = std::numbers::pi / 180;
  camera.turn_to(static_cast<float>(sight.azimuth * degree),
                 static_cast<float>(sight.elevation * degree));
  camera.frame(bounds, aspect, clear);
  camera.zoom(static_cast<float>(std::log(sight.zoom) / -std::log(0.88)));
}

namespace {

// The frame of picture k of a strip: from the start to the last, evenly.
std::int64_t frame_of(const Arguments& arguments, int k) {
  return arguments.strip == 1 ? arguments.frames : arguments.frames * k / (arguments.strip - 1);
}

// Puts a picture into a strip of such, as number k.
void paste(const Picture& picture, int k, Picture& strip) {
  const std::ptrdiff_t row = 3 * picture.width, whole = 3 * strip.width;
  for (int y = 0; y < picture.height; ++y)
    std::copy_n(picture.rgb.begin() + y * row, row, strip.rgb.begin() + y * whole + k * row);
}

void refuse_problems(const Renderer& renderer) {
  std::string problems;
  for (const std::string& problem : renderer.problems()) problems += problem + "\n";
  if (!problems.empty()) throw Failure(kNoGraphics, problems);
}

}  // namespace

void render_picture(const Arguments& arguments) {
  const SceneFile file = load_scene(arguments);
  refuse_clashes(arguments, file.path);
  Takeover takeover;
  const SurfacelessContext context;
  Options options;
  options.threads = arguments.threads;
  options.seed = arguments.seed;
  Simulation simulation(file.scene, options);

  FrameData frame_data;
  copy_view(simulation.view(), simulation.scene(), frame_data);
  const Vec3& origin = frame_data.origin;
  frame_data.scene =
      std::make_shared<const Scene>(moved(file.scene, {-origin[0], -origin[1], -origin[2]}));
  const Setting setting = setting_of(frame_data);

  Renderer renderer(arguments.pictures);
  const RenderTarget target(arguments.width, arguments.height, 8);
  const float aspect = static_cast<float>(arguments.width) / static_cast<float>(arguments.height);
  Camera camera;
  Picture strip{arguments.strip * arguments.width, arguments.height, {}};
  strip.rgb.resize(std::size_t{3} * strip.width * strip.height);
  for (int k = 0; k < arguments.strip; ++k) {
    while (simulation.frame() < frame_of(arguments, k) && simulation.status().ok &&
           interrupted() == 0)
      simulation.advance_frame();
    if (interrupted() != 0) return;  // a picture of another frame is not what was asked for
    copy_view(simulation.view(), simulation.scene(), frame_data);
    frame_data.frame = simulation.frame();
    Bounds bounds = seen_bounds(frame_data, setting);
    if (arguments.strip > 1) bounds.add(setting.room);  // one view for all
    if (k == 0) aim(sight_of(arguments, file.scene), bounds, aspect, 1, camera);
    LookSettings settings = arguments.settings;
    settings.fine = settings.quality == Quality::fine;
    renderer.draw(frame_data, setting, *find_look(arguments.look), settings, camera, target);
    refuse_problems(renderer);
    paste(target.read(), k, strip);
  }
  takeover.stop();
  write_png(arguments.out, strip);
  if (!simulation.status().ok)
    throw Failure(kStopped, "the simulation stopped itself: " + simulation.status().text);
}

}  // namespace weft::viewer
