// A run as it can be told again: the scene, every input of a person between two frames, and the hash
// of each frame. A replay gives the same bits, or names the first frame that differs.
//
// The file has one JSON object a line: first {"weft_recording": 2, "seed": …, "scene": {…}}, then
// inputs {"frame": f, "grab": {…}} in order, given before frame f + 1 is computed, and hashes
// {"frame": f, "hash": "16 hex digits"} of the state after frame f. Particles are [cloth, number]; files of version 1,
// where they are [cloth, column, row], are read as well. A line whose scene has meshes that no line before it has
// carries them, "meshes": {FILE: text of a Wavefront .obj}, so that a recording needs no other file.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "weft/output.h"
#include "weft/simulation.h"

namespace weft {

// What a person does to a simulation: a call of the method of that name.
struct Input {
  enum class Kind { grab, release, pin, unpin, carry, cut, move_collider, set_scene };
  Kind kind = Kind::release;
  int cloth = 0, particle = 0;  // grab, pin, unpin; carry: cloth
  int collider = 0;             // move_collider
  Vec3 a{}, b{};                // grab, move_collider: a the target; carry: a the velocity; cut
  double amount = 0;            // grab: stiffness [N/m]; cut: width [m]
  std::shared_ptr<const Scene> scene = nullptr;  // set_scene
};

// Makes the call; throws what it throws.
void apply(const Input& input, Simulation& simulation);

// Writes a recording as it happens. Throws WriteError, also for a mesh that a program made, which has no file to
// be named by, and for one of more than 32 MiB of text.
class Recorder {
 public:
  // The simulation stands at its start.
  Recorder(const std::string& path, const Simulation& simulation);
  // An input that was applied when the simulation stood at a frame.
  void input(std::int64_t frame, const Input& input);
  // Right after advance_frame(); a simulation that has stopped itself adds nothing.
  void frame(const Simulation& simulation);
  // Gives the file its name: complete(), then commit(), which are those of OutputFile.
  void finish();
  void complete() { file_.complete(); }
  void commit() { file_.commit(); }
  const std::string& path() const { return file_.path(); }

 private:
  using Texts = std::map<std::string, std::string>;
  Texts new_meshes(const Scene& scene);
  Texts new_animations(const Scene& scene);

  OutputFile file_;
  // That are written, by file.
  std::map<std::string, std::shared_ptr<const TriangleMesh>> meshes_;
  std::map<std::string, std::shared_ptr<const PointCache>> animations_;
};

// A recording cannot be read: what() says where and why.
struct RecordingError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct Recording {
  struct Event {
    std::int64_t frame = 0;
    std::optional<Input> input;  // else a hash
    std::uint64_t hash = 0;
  };
  Scene scene;
  std::uint64_t seed = 1;
  std::vector<Event> events;    // in order
  std::int64_t frames() const;  // how many have a hash
};

// Throws RecordingError.
Recording read_recording(const std::string& path);

// Where two scenes differ first, as a JSON pointer; "" when they are equal. Meshes that are read are compared by
// what they are, wherever their files lie.
std::string difference(const Scene& a, const Scene& b);

// The next input that comes before the next frame, null when there is none; `next` counts the events
// done so far. Throws RecordingError when it belongs to another frame.
const Input* next_input(const Recording& recording, std::size_t& next,
                        const Simulation& simulation);
// Compares with the hash of the frame just computed; throws RecordingError where it differs.
void compare_hash(const Recording& recording, std::size_t& next, const Simulation& simulation);

}  // namespace weft
