// The scene as a person edits it: a document of every value, whose changes are checked as a file
// is, undone and redone, and saved. A change that validation refuses changes nothing.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "scene/json_text.h"
#include "weft/mesh.h"
#include "weft/read_scene.h"

namespace weft::viewer {

class Document {
 public:
  // Reads a scene file or a shipped scene; with faults the document stays as it was.
  std::vector<Fault> open(const std::string& path_or_name,
                          const std::vector<Override>& overrides = {});

  // What was read otherwise than the file has it (SceneFile::notes).
  const std::vector<std::string>& notes() const { return notes_; }
  const Scene& scene() const { return scene_; }
  const text::Json& json() const { return json_; }
  const std::string& path() const { return path_; }  // of the file
  bool shipped() const { return shipped_; }
  const std::string& name() const { return name_; }
  bool edited() const { return revision_ != saved_revision_; }
  // Rises or falls with every change, so that equal numbers mean equal scenes.
  std::uint64_t revision() const { return revision_; }

  // Changes one value by JSON pointer, or several as one step; "" or what is wrong and allowed.
  // `joined`: part of the same movement as the last change of the same place and name, undone together. `name`: what
  // a person calls the change, "" for the name of its place.
  struct Change {
    std::string pointer;
    text::Json value;
  };
  std::string set(const std::vector<Change>& changes, bool joined = false,
                  const std::string& name = "");

  bool can_undo() const { return position_ > 0; }
  bool can_redo() const { return position_ + 1 < history_.size(); }
  void undo();
  void redo();
  std::string next_undo() const;  // the name of what undo would take back

  // Throws WriteError.
  void save(const std::string& path);
  // Where save() goes unless told: the file itself, or a new one beside nothing of the shipped.
  std::string save_path() const;

  // Writes what is not saved to the place of unsaved edits, and removes it there when nothing is;
  // "" or what went wrong.
  std::string keep() const;
  // The file of unsaved edits of this scene from an earlier time, "" when there is none.
  std::string kept() const;

  // Whether the file has changed on disk since it was read or written.
  bool changed_on_disk();

 private:
  struct State {
    text::Json json;
    std::string place, name;
    std::uint64_t revision;
  };
  void take(std::size_t position);
  // Files of meshes are read once.
  std::vector<Fault> read_meshes(Scene& scene);
  // The scene as a file; meshes in its folder or below go by relative names, as they came.
  std::string text_for(const std::string& path) const;
  std::string name_of(const std::string& pointer) const;
  std::string keep_path() const;

  text::Json json_;
  std::vector<std::string> notes_;
  Scene scene_;
  MeshStore meshes_;  // that are read
  std::string path_, name_;
  bool shipped_ = false;
  std::vector<State> history_;
  std::size_t position_ = 0;
  std::uint64_t revision_ = 0, saved_revision_ = 0, revisions_ = 0;
  std::filesystem::file_time_type time_{};
};

// A particle as scenes name it: [i, j] of a grid, its number of a mesh.
text::Json pin_json(const Cloth& cloth, int particle);

// A pin that holds what another does, but stands still.
text::Json still_pin_json(const Cloth& cloth, const Pin& pin);

// A pin of several particles, as the document has it, without those let go; null where it holds no other.
text::Json remaining_pin_json(const text::Json& pin, const std::vector<int>& held,
                              const std::set<int>& let_go);

// What to change in a document of `before` for one of `after`: the values at its top that differ.
std::vector<Document::Change> changes_between(const Scene& before, const Scene& after);

// "file.json:/pointer: what (allowed)", a line for each fault.
std::string fault_lines(const std::string& file, const std::vector<Fault>& faults);

}  // namespace weft::viewer
