// What the window works on: the scene as edited, the simulation that plays it, and how it is shown.
#pragma once

#include <optional>
#include <string>

#include "command_line.h"
#include "edit/parts.h"
#include "picture/renderer.h"
#include "run/session.h"
#include "window/messages.h"

namespace weft::viewer {

class Workspace {
 public:
  // Opens the scene of the arguments. Throws Failure.
  explicit Workspace(const Arguments& arguments);

  // Ends the simulation, with all files of it: what went wrong, or "". ended(): see Session.
  std::string end();
  bool ended() const { return session_->ended(); }
  // The file of the recording, "" where none was asked for.
  const std::string& record() const { return record_; }

  // Another scene; a broken one is told, and the present one stays.
  void open(const std::string& path_or_name);
  void open_neighbour(int step);  // in the list of shipped scenes
  void reset();
  void save(const std::string& path);

  // Changes values of the scene, checked; the simulation goes on with them. False when refused.
  // `name`: for undo (Document::set).
  bool edit(const std::vector<Document::Change>& changes, bool joined = false,
            const std::string& name = "");
  // The same for the scene as a whole.
  bool edit(const Scene& scene, const std::string& name, bool joined = false);
  // Puts a cloth, or a body of the shape (shapes_of_size()), where the camera looks.
  bool add_cloth();
  bool add_body(std::size_t number);
  // Puts in what a file of a mesh has, which is read (weft/mesh.h).
  bool add_mesh(Kind kind, const MeshSource& mesh);
  // Puts the part beside itself once more, or takes it away.
  bool duplicate(const Part& part);
  bool remove(const Part& part);
  void undo();
  void redo();
  void set_options(int threads, Simd simd);

  void play(bool on);
  void set_speed(double speed);
  void step();
  void go_back(int back);  // states before the newest kept
  void give(const Input& input);

  // Writes the animation of the frames first … last to a file in a format of weft/output.h; without a last one
  // until end_export(). Where the scene is past the first, it starts anew; without a first one it goes on from the
  // frame that it has come to.
  void start_export(const std::string& path, std::optional<std::int64_t> first,
                    std::optional<std::int64_t> last);
  // That frame alone.
  void export_frame(const std::string& path);
  void end_export();

  void next_look(int step);
  void frame_cloth();
  // The view that the scene opens with, and the cloth from a direction [rad].
  void show_home();
  void show_along(float azimuth, float elevation);

  // Once a turn: takes the newest state, posts what waits, looks after the scene's file. True: there is a new
  // state.
  bool refresh(double now);

  const Document& document() const { return document_; }
  // Frames from this time of the simulation on [s] wait.
  void wait_at(double time);
  const FrameData& frame_data() const { return session_->shown().frame_data; }
  // A point that is shown, where it stands in the scene [m].
  Vec3 in_scene(Vec3f shown) const;
  const Telemetry& telemetry() const { return session_->shown().telemetry; }
  const Setting& setting() const { return setting_; }
  const std::vector<ShippedScene>& scenes() const { return scenes_; }
  double now() const { return now_; }
  int threads() const { return threads_; }
  Simd simd() const { return simd_; }
  float aspect() const { return aspect_; }
  // Of the picture: width over height, and the share of its height that no control covers.
  // Known from the first turn on, which shows the scene as it opens.
  void set_picture(float aspect, float clear);

  Camera camera;
  const Look* look;
  LookSettings settings;
  PictureFiles pictures;
  Messages messages;

 private:
  void show_start();
  void take_setting(const Setting& setting);
  Bounds to_frame() const;
  void post_change();
  void watch_file();
  void keep_edits();
  void tell_notes();
  void tell_kept();

  Document document_;
  std::vector<ShippedScene> scenes_ = shipped_scenes();
  std::string record_;
  std::optional<Session> session_;
  Setting setting_;
  double now_ = 0, next_watch_ = 0, next_keep_ = 0;
  Sight sight_;
  float aspect_ = 0, clear_ = 1;
  int threads_ = 0;
  Simd simd_ = Simd::best;
  bool opening_ = false;         // the next new scene is shown from its start
  std::uint64_t serial_ = 0;     // of the scene that is shown
  std::uint64_t simulated_ = 0;  // revision that the simulation has, or was told of
  bool telling_ = false;         // a change is on its way
  std::int64_t problems_ = 0;
  std::string recorded_;
  std::uint64_t kept_ = 0;  // revision of the edits that are kept
};

}  // namespace weft::viewer
