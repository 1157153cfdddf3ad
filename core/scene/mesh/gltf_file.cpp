#include "scene/mesh/gltf_file.h"

#include "scene/mesh/words.h"

namespace weft::text {
namespace {

// Extensions that a file may say it cannot be read without, since they say nothing of where triangles are.
bool is_harmless(const std::string& extension) {
  for (const char* known : {"KHR_materials_", "KHR_texture_", "EXT_texture_", "MSFT_texture_",
                            "KHR_lights_", "KHR_mesh_quantization"})
    if (extension.starts_with(known)) return extension != "KHR_texture_transform";
  return false;
}

std::uint32_t whole_at(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t k = 0; k < 4; ++k)
    value |= std::uint32_t(static_cast<unsigned char>(bytes[at + k])) << (8 * k);
  return value;
}

struct Container {
  std::string_view json;
  std::optional<std::string_view> binary;
};

// The parts of a .glb: 12 bytes of header, then the document and the data, each with its length and kind.
Container parts_of(std::string_view bytes) {
  const auto refuse = [](const char* what, const char* allowed) {
    throw Refused{{"", what, allowed}};
  };
  if (bytes.size() < 20) refuse("the file ends early", "20 bytes at least");
  if (whole_at(bytes, 4) != 2) refuse("the version is not 2", "glTF 2.0");
  const std::size_t length = whole_at(bytes, 8);
  if (length > bytes.size() || length < 20)
    refuse("the file is not as long as its header says", "a whole file");
  bytes = bytes.substr(0, length);
  Container found;
  for (std::size_t at = 12, n = 0; at + 8 <= bytes.size() && n < 2; ++n) {
    const std::size_t size = whole_at(bytes, at);
    const std::uint32_t kind = whole_at(bytes, at + 4);
    if (size > bytes.size() - at - 8) refuse("a part is longer than the file", "a whole file");
    if (n == 0 && kind != 0x4E4F534A) refuse("the first part is no document", "JSON");
    if (n == 0) found.json = bytes.substr(at + 8, size);
    if (n == 1 && kind == 0x004E4942) found.binary = bytes.substr(at + 8, size);
    at += 8 + size;
  }
  return found;
}

void check_version(const GltfValue& document) {
  const std::string version = document.at("asset").at("version").words();
  if (!version.starts_with("2."))
    document.at("asset").at("version").refuse("the version is " + brief(Json(version)), "2.0");
  const auto required = document.find("extensionsRequired");
  for (std::size_t n = 0; required && n < required->size(); ++n)
    if (!is_harmless(required->item(n).words()))
      required->item(n).refuse(
          "the extension " + brief(Json(required->item(n).words())) + " is needed to read the file",
          "plain triangles, without compression");
}

}  // namespace

void read_gltf_file(std::string_view bytes, const std::string& name, const std::string& folder,
                    std::vector<Fault>& faults,
                    const std::function<void(const GltfValue& document, GltfData& data)>& read) {
  try {
    Container parts{without_mark(bytes), {}};
    if (bytes.starts_with("glTF")) parts = parts_of(bytes);
    std::vector<Fault> found;
    const Json json = parse(parts.json, found);
    for (Fault& fault : found) throw Refused{std::move(fault)};
    const GltfValue document{json, ""};
    check_version(document);
    GltfData data(document, parts.binary, folder);
    read(document, data);
  } catch (Refused& refused) {
    Fault& fault = refused.fault;
    if (!fault.place.empty()) fault.place.insert(0, ":");
    faults.assign(1, {name + fault.place, std::move(fault.what), std::move(fault.allowed)});
  }
}

}  // namespace weft::text
