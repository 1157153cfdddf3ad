#include "scene/mesh/gltf_data.h"

#include <bit>
#include <cmath>
#include <filesystem>

#include "scene/base64.h"
#include "scene/mesh/faces.h"
#include "scene/mesh/mesh_file.h"

namespace weft::text {
namespace {

constexpr std::size_t kMaxOffset = std::size_t{1} << 40;
constexpr std::size_t kMaxBuffers = 10000;
constexpr std::size_t kMostNumbers = kMaxMeshBytes / 4;  // as many as fit the largest file

struct Component {
  std::size_t code, bytes;
  bool real, is_signed;
};
constexpr Component kComponents[] = {{5120, 1, false, true},  {5121, 1, false, false},
                                     {5122, 2, false, true},  {5123, 2, false, false},
                                     {5125, 4, false, false}, {5126, 4, true, true}};

Component component_of(const GltfValue& accessor) {
  const GltfValue type = accessor.at("componentType");
  const std::size_t code = type.whole(kMaxOffset);
  for (const Component& known : kComponents)
    if (known.code == code) return known;
  type.refuse(std::to_string(code) + " is no type of numbers", "5120 to 5123, 5125, 5126");
}

double value_of(const char* bytes, const Component& type, bool normalised) {
  std::uint32_t bits = 0;
  for (std::size_t k = 0; k < type.bytes; ++k)
    bits |= std::uint32_t(static_cast<unsigned char>(bytes[k])) << (8 * k);
  if (type.real) return double(std::bit_cast<float>(bits));
  const std::size_t unused = 32 - 8 * type.bytes;
  const double value = type.is_signed ? double(std::int32_t(bits << unused) >> unused) : bits;
  if (!normalised) return value;
  const double most = std::pow(2, double(8 * type.bytes) - (type.is_signed ? 1 : 0)) - 1;
  return std::max(value / most, -1.0);
}

// A URI as the name of a file: %XX are bytes. Refused: what is no plain name below the folder.
std::string name_of_uri(const GltfValue& buffer, const std::string& uri) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string name;
  for (std::size_t n = 0; n < uri.size(); ++n) {
    if (uri[n] != '%') {
      name += uri[n];
      continue;
    }
    int byte = 0;
    for (std::size_t k = 1; k <= 2; ++k) {
      const char c = n + k < uri.size() ? uri[n + k] : ' ';
      const std::size_t digit = kDigits.find(c >= 'A' && c <= 'F' ? char(c - 'A' + 'a') : c);
      if (digit == std::string_view::npos)
        buffer.at("uri").refuse("the address is broken", "%XX with two hexadecimal digits");
      byte = 16 * byte + int(digit);
    }
    name += char(byte);
    n += 2;
  }
  const std::filesystem::path path(name);
  const bool upward = std::find(path.begin(), path.end(), "..") != path.end();
  if (name.empty() || path.is_absolute() || upward || name.find(':') != std::string::npos ||
      name.find('\0') != std::string::npos)
    buffer.at("uri").refuse("the address is of no file beside this one",
                            "a file in the same folder or below, or data:…;base64,…");
  return name;
}

}  // namespace

GltfData::GltfData(const GltfValue& document, std::optional<std::string_view> binary,
                   std::string folder)
    : document_(document), binary_(binary), folder_(std::move(folder)) {
  const auto buffers = document.find("buffers");
  if (buffers && buffers->size() > kMaxBuffers)
    buffers->refuse("there are " + std::to_string(buffers->size()) + " buffers", "at most 10000");
  loaded_.resize(buffers ? buffers->size() : 0);
}

GltfValue GltfData::accessor(std::size_t n) const {
  return document_.at("accessors").item(n);
}

std::size_t GltfData::count(std::size_t n, std::size_t most) const {
  return accessor(n).at("count").whole(most);
}

std::vector<double> GltfData::numbers(std::size_t n, const char* type) {
  const GltfValue from = accessor(n);
  if (from.at("type").words() != type)
    from.at("type").refuse(brief(Json(from.at("type").words())) + " is out of place", type);
  const std::string_view name = type;
  const std::size_t width = name == "SCALAR" ? 1
                            : name == "VEC2" ? 2
                            : name == "VEC3" ? 3
                            : name == "VEC4" ? 4
                                             : 16;
  const Component component = component_of(from);
  if (width == 16 && !component.real)
    from.at("componentType").refuse("the matrices are of whole numbers", "5126");
  const auto normalised = from.find("normalized");
  const bool shares = normalised && normalised->is_true();
  const std::size_t count = from.at("count").whole(kMostNumbers / width);
  numbers_ += width * count;
  if (numbers_ > kMostNumbers)
    from.refuse("the accessors list more numbers than fit",
                std::to_string(kMostNumbers) + " of all, each time that one is used");
  std::vector<double> values(width * count);
  const auto read = [&](const Span& span, std::size_t e, std::size_t to) {
    for (std::size_t k = 0; k < width; ++k) {
      const char* at = span.bytes.data() + e * span.stride + k * component.bytes;
      values[width * to + k] = value_of(at, component, shares);
      if (!std::isfinite(values[width * to + k]))
        from.refuse("element " + std::to_string(to) + " is not finite", "finite numbers");
    }
  };
  if (from.find("bufferView")) {
    const Span span = span_of(from, count, width * component.bytes);
    for (std::size_t e = 0; e < count; ++e) read(span, e, e);
  }
  const auto sparse = from.find("sparse");
  if (!sparse) return values;
  const std::size_t few = sparse->at("count").whole(count);
  const GltfValue indices = sparse->at("indices");
  const Component whole = component_of(indices);
  const Span places = span_of(indices, few, whole.bytes);
  const Span given = span_of(sparse->at("values"), few, width * component.bytes);
  for (std::size_t e = 0; e < few; ++e) {
    const double to = value_of(places.bytes.data() + e * places.stride, whole, false);
    if (whole.real || !(to >= 0 && to < double(count)))
      indices.refuse("index " + std::to_string(e) + " is " + number_words(to),
                     "below " + std::to_string(count) + ", as there are elements");
    read(given, e, std::size_t(to));
  }
  return values;
}

GltfData::Span GltfData::span_of(const GltfValue& from, std::size_t count, std::size_t element) {
  const GltfValue index = from.at("bufferView");
  const GltfValue view = document_.at("bufferViews").item(index.whole(kMaxOffset));
  if (const auto more = view.find("extensions"))
    if (more->find("EXT_meshopt_compression") || more->find("KHR_meshopt_compression"))
      more->refuse("the view is compressed", "data without compression");
  const std::string_view all = buffer(view.at("buffer").whole(kMaxOffset));
  const std::size_t begin = view.whole_or("byteOffset", 0, kMaxOffset);
  const std::size_t length = view.at("byteLength").whole(kMaxOffset);
  if (begin > all.size() || length > all.size() - begin)
    view.refuse("the view reaches to byte " + std::to_string(begin + length) + " of its buffer",
                std::to_string(all.size()) + " at most, which the buffer has");
  const std::size_t stride = view.whole_or("byteStride", element, 252);
  if (stride < element)
    view.at("byteStride")
        .refuse("elements of " + std::to_string(element) + " bytes are " + std::to_string(stride) +
                    " apart",
                std::to_string(element) + " to 252");
  const std::size_t offset = from.whole_or("byteOffset", 0, kMaxOffset);
  if (count > 0 && offset + (count - 1) * stride + element > length)
    from.refuse("the accessor reaches to byte " +
                    std::to_string(offset + (count - 1) * stride + element) + " of its view",
                std::to_string(length) + " at most, which the view has");
  return {all.substr(begin, length).substr(count > 0 ? offset : 0), stride};
}

std::string_view GltfData::buffer(std::size_t n) {
  const GltfValue buffer = document_.at("buffers").item(n);
  const std::size_t length = buffer.at("byteLength").whole(kMaxMeshBytes);
  const auto uri = buffer.find("uri");
  if (uri && !loaded_[n]) loaded_[n] = load(buffer, uri->words());
  if (!uri && (n > 0 || !binary_))
    buffer.refuse("the buffer has no data", "uri, or the binary part of a .glb for the first");
  const std::string_view all = uri ? std::string_view(*loaded_[n]) : *binary_;
  if (all.size() < length)
    buffer.at("byteLength")
        .refuse("the buffer is to have " + std::to_string(length) + " bytes",
                std::to_string(all.size()) + ", which are there");
  return all.substr(0, length);
}

std::string GltfData::load(const GltfValue& buffer, const std::string& uri) {
  std::string bytes;
  if (uri.starts_with("data:")) {
    constexpr std::string_view kMark = ";base64,";
    const std::size_t mark = uri.substr(0, 200).find(kMark);
    std::optional<std::string> data;
    if (mark != std::string::npos)
      data = from_base64(std::string_view(uri).substr(mark + kMark.size()));
    if (!data) buffer.at("uri").refuse("the data is no base64", "data:…;base64,…");
    bytes = std::move(*data);
  } else {
    const std::string path = (std::filesystem::path(folder_) / name_of_uri(buffer, uri)).string();
    FileBytes file = bytes_of_file(path, kMaxMeshBytes - loaded_bytes_);
    if (file.fault) buffer.at("uri").refuse(path + ": " + file.fault, file.allowed);
    bytes = std::move(file.bytes);
  }
  loaded_bytes_ += bytes.size();
  return bytes;
}

}  // namespace weft::text
