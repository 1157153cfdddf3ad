// Wavefront .obj -> TriangleMesh, line by line, so that every fault has its line.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <map>
#include <set>

#include "scene/mesh/faces.h"

namespace weft {
namespace text {
namespace {

constexpr std::size_t kMaxMeshBytes = std::size_t{1} << 30;
constexpr std::size_t kMaxCorners = 256;  // of one face, which is cut in the square of them
constexpr double kFarthest = 1e9;         // in the file's own units

// Words between blanks, one after the other.
class Words {
 public:
  explicit Words(std::string_view line) : left_(line) {}
  std::string_view next() {
    const auto begin = left_.find_first_not_of(" \t\r");
    if (begin == std::string_view::npos) return left_ = {};
    left_.remove_prefix(begin);
    const std::string_view word = left_.substr(0, left_.find_first_of(" \t\r"));
    left_.remove_prefix(word.size());
    return word;
  }
  std::string_view rest() {
    const auto begin = left_.find_first_not_of(" \t\r");
    if (begin == std::string_view::npos) return {};
    return left_.substr(begin, left_.find_last_not_of(" \t\r") + 1 - begin);
  }

 private:
  std::string_view left_;
};

template <class Number>
bool parse(std::string_view word, Number& number) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  return error == std::errc() && end == word.data() + word.size() && !word.empty();
}

struct Corner {
  int vertex = 0, uv = -1;  // -1: none
};

class Reader {
 public:
  Reader(std::string_view text, const std::string& name, MeshFile& file)
      : text_(text), raw_{file, name, {}} {}

  void run() {
    for (std::size_t at = 0; at < text_.size() && !raw_.full();) {
      const std::size_t end = std::min(text_.find('\n', at), text_.size());
      ++line_;
      statement(text_.substr(at, end - at));
      at = end + 1;
    }
    close_groups();
    if (!has_uv_) mesh().uv.clear();
    if (mesh().triangles.empty() && raw_.file.faults.empty())
      raw_.fault(0, "the mesh has no faces", "at least one");
    if (raw_.file.faults.empty()) repair(raw_);
  }

 private:
  TriangleMesh& mesh() { return raw_.file.mesh; }
  void fault(std::string what, std::string allowed) {
    raw_.fault(line_, std::move(what), std::move(allowed));
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
      begin_group(key == "o", std::string(words.rest()));
    }
  }

  // So many finite numbers, or a fault.
  template <std::size_t N>
  bool numbers(Words& words, std::array<double, N>& values) {
    for (double& value : values) {
      const std::string_view word = words.next();
      if (!parse(word, value) || !(std::abs(value) <= kFarthest)) {
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
    if (parse(word, number) && number != 0) {
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
    if (all.size() < 3)
      return fault("the face has " + std::to_string(all.size()) + " corners", "3 to 256");
    if (drop_repeated(all))
      ++repeated_, first_repeated_ = first_repeated_ ? first_repeated_ : line_;
    if (all.size() < 3) return;
    std::vector<Vec3> at;
    for (const Corner& c : all) at.push_back(mesh().vertices[std::size_t(c.vertex)]);
    for (const auto& [a, b, c] : triangles_of(at))
      triangle({all[std::size_t(a)], all[std::size_t(b)], all[std::size_t(c)]});
  }

  // Corners that are the vertex of the corner before.
  static bool drop_repeated(std::vector<Corner>& all) {
    std::vector<Corner> kept;
    for (const Corner& c : all)
      if (kept.empty() || kept.back().vertex != c.vertex) kept.push_back(c);
    while (kept.size() > 1 && kept.front().vertex == kept.back().vertex) kept.pop_back();
    const bool dropped = kept.size() < all.size();
    all = std::move(kept);
    return dropped;
  }

  void triangle(const std::array<Corner, 3>& corners) {
    if (mesh().triangles.size() == kMaxTriangles) {
      if (!raw_.full()) fault("the mesh has more triangles", "at most 4194304");
      text_ = text_.substr(0, 0);
      return;
    }
    std::array<int, 3> t{};
    std::array<TriangleMesh::Uv, 3> uv{};
    const bool mapped = corners[0].uv >= 0 && corners[1].uv >= 0 && corners[2].uv >= 0;
    has_uv_ |= mapped;
    for (std::size_t k = 0; k < 3; ++k) {
      t[k] = corners[k].vertex;
      if (mapped) uv[k] = uv_[std::size_t(corners[k].uv)];
      for (std::set<int>* group : open_)
        if (group) group->insert(t[k]);
    }
    mesh().triangles.push_back(t);
    mesh().uv.push_back(uv);
    raw_.lines.push_back(line_);
  }

  void loose_edges(Words& words) {
    std::vector<Corner> all;
    if (!corners(words, all)) return;
    for (std::size_t k = 1; k < all.size(); ++k) {
      if (mesh().edges.size() == 4 * kMaxVertices) {
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
    if (repeated_ > 0)
      raw_.note(std::to_string(repeated_) + (repeated_ == 1 ? " face repeats" : " faces repeat") +
                " a vertex, first in line " + std::to_string(first_repeated_) +
                "; the repeated corners are left out");
  }

  std::string_view text_;
  RawMesh raw_;
  int line_ = 0;
  std::vector<TriangleMesh::Uv> uv_;
  bool has_uv_ = false;
  std::map<std::string, std::set<int>> groups_;
  std::array<std::set<int>*, 2> open_{};  // the object and the group that faces belong to
  int repeated_ = 0, first_repeated_ = 0;
};

}  // namespace
}  // namespace text

MeshFile read_obj(std::string_view text, const std::string& name) {
  MeshFile file;
  text::Reader(text, name, file).run();
  return file;
}

bool is_mesh_file(std::string_view path) {
  constexpr std::string_view kEnd = ".obj";
  return path.size() >= kEnd.size() &&
         std::equal(kEnd.begin(), kEnd.end(), path.end() - std::ptrdiff_t(kEnd.size()),
                    [](char small, char c) {
                      return c == small || (c >= 'A' && c <= 'Z' && c - 'A' + 'a' == small);
                    });
}

MeshFile read_mesh(const std::string& path) {
  MeshFile file;
  const auto refuse = [&](const char* what, const char* allowed) {
    file.faults.push_back({path, what, allowed});
    return file;
  };
  if (!is_mesh_file(path)) return refuse("the file is of no known kind", ".obj");
  std::ifstream in(path, std::ios::binary);
  if (!in) return refuse("there is no such mesh file", "a readable .obj file");
  std::string bytes(1 << 16, '\0'), all;
  while (in.read(bytes.data(), std::streamsize(bytes.size())), in.gcount() > 0) {
    all.append(bytes, 0, std::size_t(in.gcount()));
    if (all.size() > text::kMaxMeshBytes) return refuse("the file is larger", "at most 1 GiB");
  }
  if (in.bad() || !in.eof()) return refuse("the file cannot be read", "a readable .obj file");
  return read_obj(all, path);
}

}  // namespace weft
