// Wavefront .obj -> TriangleMesh, statement by statement, so that every fault has its line.
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "scene/mesh/polygons.h"
#include "scene/mesh/words.h"

namespace weft {
namespace text {
namespace {

class Reader {
 public:
  Reader(std::string_view text, const std::string& name, MeshFile& file)
      : text_(without_mark(text)), raw_{file, name} {}

  void run() {
    if (text_.find('\n') == std::string_view::npos) line_end_ = '\r';
    while (at_ < text_.size() && !raw_.full()) statement(next_statement());
    close_groups();
    polygons_.finish();
  }

 private:
  TriangleMesh& mesh() { return raw_.file.mesh; }
  void fault(std::string what, std::string allowed) {
    raw_.fault(line_, std::move(what), std::move(allowed));
  }

  std::string_view next_line() {
    if (at_ >= text_.size()) return {};
    const std::size_t end = std::min(text_.find(line_end_, at_), text_.size());
    const std::string_view line = text_.substr(at_, end - at_);
    at_ = end + 1;
    ++lines_;
    return line;
  }

  // The line up to the backslash by which its statement goes on in the next; comments do not go on.
  static std::optional<std::string_view> goes_on(std::string_view line) {
    line = line.substr(0, line.find_last_not_of(" \t\r") + 1);
    if (!line.ends_with('\\') || line.find('#') != std::string_view::npos) return {};
    return line.substr(0, line.size() - 1);
  }

  std::string_view next_statement() {
    std::string_view line = next_line();
    line_ = lines_;
    auto part = goes_on(line);
    if (!part) return line;
    joined_.clear();
    for (; part; part = goes_on(line = next_line())) joined_.append(*part) += ' ';
    return joined_.append(line);
  }

  void statement(std::string_view line) {
    Words words(line.substr(0, line.find('#')));
    const std::string_view key = words.next();
    if (key == "v") {
      vertex(words);
    } else if (key == "vt") {
      texture(words);
    } else if (key == "f") {
      face(words);
    } else if (key == "l") {
      loose_edges(words);
    } else if (key == "o" || key == "g") {
      begin_group(key == "o", name_in(line));
    }
  }

  // A name may hold a "#" that begins no word.
  static std::string name_in(std::string_view line) {
    Words words(line.substr(0, std::min(line.find(" #"), line.find("\t#"))));
    words.next();
    return std::string(words.rest());
  }

  // So many finite numbers, or a fault.
  template <std::size_t N>
  bool numbers(Words& words, std::array<double, N>& values) {
    for (double& value : values) {
      const std::string_view word = words.next();
      if (!parse_number(word, value) || !(std::abs(value) <= kFarthestPlace)) {
        fault(word.empty() ? "a number is missing"
                           : "\"" + std::string(word.substr(0, 40)) + "\" is no coordinate",
              "numbers, -1e9 to 1e9");
        return false;
      }
    }
    return true;
  }

  void vertex(Words& words) {
    Vec3 at{};
    if (!numbers(words, at)) at = {};
    if (mesh().vertices.size() == kMaxVertices) {
      fault("the mesh has more vertices", "at most 4194304");
      text_ = text_.substr(0, 0);
      return;
    }
    mesh().vertices.push_back(at);
  }

  void texture(Words& words) {
    TriangleMesh::Uv at{};
    if (!numbers(words, at)) at = {};
    if (uv_.size() == 4 * kMaxVertices) {
      fault("the mesh has more texture coordinates", "at most 16777216");
      text_ = text_.substr(0, 0);
      return;
    }
    uv_.push_back(at);
  }

  // The index of a list with `count` entries so far: from 1, or from the end where negative.
  bool index(std::string_view word, const char* list, std::size_t count, int& index) {
    long number = 0;
    if (parse_number(word, number) && number != 0) {
      const long from_zero = number > 0 ? number - 1 : long(count) + number;
      if (from_zero >= 0 && from_zero < long(count)) return index = int(from_zero), true;
    }
    fault("there is no " + std::string(list) + " \"" + std::string(word.substr(0, 40)) + "\"",
          count == 0 ? "none comes before" : "1 to " + std::to_string(count) + ", or from -1 down");
    return false;
  }

  bool corner(std::string_view word, Corner& corner) {
    const auto slash = word.find('/');
    if (!index(word.substr(0, slash), "vertex", mesh().vertices.size(), corner.vertex))
      return false;
    if (slash == std::string_view::npos) return true;
    std::string_view uv = word.substr(slash + 1);
    uv = uv.substr(0, uv.find('/'));
    return uv.empty() || index(uv, "texture coordinate", uv_.size(), corner.uv);
  }

  bool corners(Words& words, std::vector<Corner>& all) {
    for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
      Corner one;
      if (!corner(word, one)) return false;
      if (all.size() == kMaxCorners) return fault("the face has more corners", "3 to 256"), false;
      all.push_back(one);
    }
    return true;
  }

  void face(Words& words) {
    std::vector<Corner> all;
    if (!corners(words, all)) return;
    const std::size_t before = mesh().triangles.size();
    if (!polygons_.add(std::move(all), uv_, line_)) text_ = text_.substr(0, 0);
    for (std::size_t t = before; t < mesh().triangles.size(); ++t)
      for (std::set<int>* group : open_)
        if (group) group->insert(mesh().triangles[t].begin(), mesh().triangles[t].end());
  }

  void loose_edges(Words& words) {
    std::vector<Corner> all;
    if (!corners(words, all)) return;
    for (std::size_t k = 1; k < all.size(); ++k) {
      if (mesh().edges.size() == kMaxLooseEdges) {
        fault("the mesh has more loose edges", "at most 16777216");
        text_ = text_.substr(0, 0);
        return;
      }
      mesh().edges.push_back({all[k - 1].vertex, all[k].vertex});
    }
  }

  // A new object ends the group, too.
  void begin_group(bool object, const std::string& name) {
    if (object) open_[1] = nullptr;
    open_[object ? 0 : 1] = name.empty() ? nullptr : &groups_[name];
  }

  void close_groups() {
    for (const auto& [name, vertices] : groups_)
      if (!vertices.empty()) mesh().groups.push_back({name, {vertices.begin(), vertices.end()}});
  }

  std::string_view text_;
  std::size_t at_ = 0;
  char line_end_ = '\n';  // a blank may come before it
  int lines_ = 0;         // so far
  std::string joined_;    // a statement of several lines
  RawMesh raw_;
  Polygons polygons_{raw_};
  int line_ = 0;  // where the statement begins
  std::vector<TriangleMesh::Uv> uv_;
  std::map<std::string, std::set<int>> groups_;
  std::array<std::set<int>*, 2> open_{};  // the object and the group that faces belong to
};

}  // namespace
}  // namespace text

MeshFile read_obj(std::string_view text, const std::string& name) {
  MeshFile file;
  text::Reader(text, name, file).run();
  return file;
}

}  // namespace weft
