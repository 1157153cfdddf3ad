// A control for every value of the scene, made from the schema: its name, unit, range and help are
// those that validation and the documentation speak from.
#pragma once

#include <optional>
#include <string>

#include "window/workspace.h"

namespace weft::viewer {

class Parameters {
 public:
  void draw_search();
  void draw(Workspace& workspace);
  // Whether a word is looked for: then nothing else is shown.
  bool searching() const { return !filter_.empty(); }
  // Whether a control of that name is shown, in view of what is looked for.
  bool shows(const std::string& name) const { return !searching() || named("", name); }

 private:
  using Json = text::Json;

  void group(const std::string& pointer, const std::string& title, const Json& schema,
             const Json& value, bool open);
  void members(const std::string& pointer, const Json& schema, const Json& value);
  void member(const std::string& pointer, const std::string& key, const Json& schema,
              const Json& value);
  void number(const std::string& pointer, const std::string& label, const Json& schema,
              const Json& value);
  void numbers(const std::string& pointer, const std::string& label, const Json& schema,
               const Json& value);
  void choice(const std::string& pointer, const std::string& label, const Json& schema,
              const Json& value);
  void substeps(const std::string& pointer, const std::string& label, const Json& schema,
                const Json& value);
  void word(const std::string& pointer, const std::string& label, const Json& value);
  void color(const std::string& pointer, const std::string& label, const Json& value);
  bool plain(const std::string& pointer, const std::string& label, const Json& schema,
             const Json& value);
  void form(const std::string& pointer, const Json& forms, const Json& value, const Json& chosen);
  void area_density(const std::string& pointer);

  // Lists (lists.cpp). Whether the list has controls of its own.
  bool list(const std::string& pointer, const std::string& key, const Json& value);
  void as_text(const std::string& pointer, const std::string& label, const Json& value);
  void pins(const std::string& pointer, const Json& value);
  void pin(const std::string& pointer, const Json& value, std::size_t number, std::size_t p);
  bool pin_holds(const std::string& place, Json& pin);
  bool pin_moves(const std::string& place, Json& pin, const Vec3& at);
  void cuts(const std::string& pointer, const Json& value);
  void part_buttons(const std::string& pointer);
  void collider_path(const std::string& pointer, const Json& value);
  void vector_path(const std::string& pointer, const Json& value);
  void share_path(const std::string& pointer, const Json& value);
  bool opened(const std::string& label, const std::string& pointer) const;
  void change(const std::string& pointer, const Json& value);
  bool named(const std::string& pointer, const std::string& key) const;
  bool passes(const std::string& pointer, const std::string& key, const Json& schema) const;

  Workspace* workspace_ = nullptr;  // while drawing
  std::string filter_;
  bool whole_ = false;                    // within a group whose name is looked for
  std::string moved_;                     // the place whose control is held
  std::optional<Part> copied_, removed_;  // asked for, while drawing
};

}  // namespace weft::viewer
