#include "scene/mesh/ply_header.h"

#include <algorithm>

#include "scene/mesh/words.h"

namespace weft::text {
namespace {

constexpr std::size_t kMaxElements = 100, kMaxProperties = 1000, kMaxHeaderLine = 1000;

struct NamedType {
  std::string_view name;
  PlyType type;
};
constexpr NamedType kTypes[] = {
    {"char", {1, false, true}},    {"int8", {1, false, true}},    {"uchar", {1, false, false}},
    {"uint8", {1, false, false}},  {"short", {2, false, true}},   {"int16", {2, false, true}},
    {"ushort", {2, false, false}}, {"uint16", {2, false, false}}, {"int", {4, false, true}},
    {"int32", {4, false, true}},   {"uint", {4, false, false}},   {"uint32", {4, false, false}},
    {"float", {4, true, true}},    {"float32", {4, true, true}},  {"double", {8, true, true}},
    {"float64", {8, true, true}},
};

class Header {
 public:
  Header(std::string_view bytes, RawMesh& raw) : bytes_(bytes), raw_(raw) {}

  PlyHeader run() {
    if (next_line() != "ply") return refuse("the file does not begin as a .ply file does", "ply");
    format();
    while (raw_.file.faults.empty()) {
      if (at_ >= bytes_.size() && !ended_) return refuse("the header does not end", "end_header");
      Words words(next_line());
      const std::string_view key = words.next();
      if (key == "end_header") break;
      if (key == "element") {
        element(words);
      } else if (key == "property") {
        property(words);
      } else if (key != "comment" && key != "obj_info" && !key.empty()) {
        fault(quoted(key) + " is no line of a header", "element, property, comment, end_header");
      }
    }
    header_.bytes = at_;
    return header_;
  }

 private:
  static std::string quoted(std::string_view word) {
    return "\"" + std::string(word.substr(0, 40)) + "\"";
  }
  void fault(const std::string& what, const char* allowed) {
    raw_.fault(header_.lines, what, allowed);
  }
  PlyHeader refuse(const std::string& what, const char* allowed) {
    fault(what, allowed);
    return header_;
  }

  // Lines end with LF, or CR and LF; binary data may follow the last.
  std::string_view next_line() {
    const std::size_t end = bytes_.substr(at_, kMaxHeaderLine).find('\n');
    const std::string_view line = bytes_.substr(at_, std::min(end, kMaxHeaderLine));
    at_ = end == std::string_view::npos ? bytes_.size() : at_ + end + 1;
    ended_ = end != std::string_view::npos;
    ++header_.lines;
    return line.ends_with('\r') ? line.substr(0, line.size() - 1) : line;
  }

  void format() {
    Words words(next_line());
    const std::string_view key = words.next(), format = words.next(), version = words.next();
    header_.ascii = format == "ascii";
    if (format == "binary_big_endian") header_.order = std::endian::big;
    const bool known =
        header_.ascii || format == "binary_little_endian" || format == "binary_big_endian";
    if (key != "format" || !known || version != "1.0")
      fault("the format is " + quoted(format) + ", version " + quoted(version),
            "format ascii, binary_little_endian or binary_big_endian, version 1.0");
  }

  void element(Words& words) {
    PlyElement element;
    element.name = words.next();
    const std::string_view count = words.next();
    if (!parse_number(count, element.count))
      return fault(quoted(count) + " is no count of elements", "a whole number from 0 on");
    if (header_.elements.size() == kMaxElements)
      return fault("the file has more elements", "at most 100 kinds");
    // A row takes a byte at least, in any format.
    if (element.count > kMaxMeshBytes) return fault("the file has more rows", "at most 1073741824");
    if (element.name == "vertex" && element.count > kMaxVertices)
      return fault("the mesh has " + std::to_string(element.count) + " vertices",
                   "at most 4194304");
    if (element.name == "face" && element.count > kMaxTriangles)
      return fault("the mesh has " + std::to_string(element.count) + " faces", "at most 4194304");
    header_.elements.push_back(std::move(element));
  }

  std::optional<PlyType> type_of(std::string_view name) {
    for (const NamedType& known : kTypes)
      if (known.name == name) return known.type;
    fault(quoted(name) + " is no type of numbers", "char to double, int8 to float64");
    return {};
  }

  void property(Words& words) {
    if (header_.elements.empty()) return fault("a property comes before any element", "element");
    PlyElement& element = header_.elements.back();
    if (element.properties.size() == kMaxProperties)
      return fault("the element has more properties", "at most 1000");
    PlyProperty property;
    std::string_view type = words.next();
    if (type == "list") {
      property.count = type_of(words.next());
      if (!property.count) return;
      if (property.count->real) return fault("a list has a count that is not whole", "uchar, int");
      type = words.next();
    }
    const std::optional<PlyType> known = type_of(type);
    if (!known) return;
    property.type = *known;
    property.name = words.next();
    element.properties.push_back(std::move(property));
  }

  std::string_view bytes_;
  RawMesh& raw_;
  PlyHeader header_;
  std::size_t at_ = 0;
  bool ended_ = true;  // the last line had an end
};

}  // namespace

int PlyElement::find(std::string_view property) const {
  const auto at = std::find_if(properties.begin(), properties.end(),
                               [&](const PlyProperty& p) { return p.name == property; });
  return at == properties.end() ? -1 : int(at - properties.begin());
}

PlyHeader read_ply_header(std::string_view bytes, RawMesh& raw) {
  return Header(bytes, raw).run();
}

}  // namespace weft::text
