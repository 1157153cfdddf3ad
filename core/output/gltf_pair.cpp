// The steps from one pair to the next (gltf_pair.h).
#include "output/gltf_pair.h"

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace weft {

namespace fs = std::filesystem;

namespace {

std::string beside(const fs::path& path, const char* extension) {
  return (path.parent_path() / (path.stem().string() + extension)).string();
}

// The name of a file as a relative URI: what is not plain ASCII as %XX.
std::string uri_of(const std::string& path) {
  constexpr char kDigits[] = "0123456789ABCDEF";
  std::string uri;
  for (const char c : fs::path(path).filename().string()) {
    const auto byte = static_cast<unsigned char>(c);
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '-' || c == '.' || c == '_' || c == '~';
    if (plain)
      uri += c;
    else
      uri += {'%', kDigits[byte >> 4U], kDigits[byte & 15U]};
  }
  return uri;
}

bool refers_to(const std::string& gltf, const std::string& buffer) {
  std::ostringstream text;
  text << std::ifstream(gltf, std::ios::binary).rdbuf();
  return text.str().find('"' + uri_of(buffer) + '"') != std::string::npos;
}

// A second name for the bytes of a file; a copy where the file system has no such thing.
void share(const OutputFile& from, const OutputFile& to) {
  std::error_code error;
  fs::remove(to.temporary(), error);
  fs::create_hard_link(from.temporary(), to.temporary(), error);
  if (!error) return;
  fs::copy_file(from.temporary(), to.temporary(), fs::copy_options::overwrite_existing, error);
  if (error) throw WriteError(to.path(), "cannot write: " + error.message());
}

}  // namespace

std::vector<std::string> GltfPair::names(const std::string& path) {
  return {path, beside(path, ".bin"), beside(path, ".weft-new.bin")};
}

GltfPair::GltfPair(const std::string& path) : json_(path), buffer_(names(path)[1], json_) {}

void GltfPair::complete(const std::function<std::string(const std::string& uri)>& document) {
  buffer_.complete();
  json_.write(document(uri_of(buffer_.path())));
  json_.complete();
  const std::string passing = names(json_.path())[2];
  std::error_code error;
  // One that was left between two pairs does not need its NAME.bin: that is free.
  if (!fs::is_regular_file(json_.path(), error) || refers_to(json_.path(), passing)) return;
  passing_buffer_.emplace(passing, json_);
  passing_buffer_->complete();
  share(buffer_, *passing_buffer_);
  passing_json_.emplace(json_.path(), json_);
  passing_json_->write(document(uri_of(passing)));
  passing_json_->complete();
}

void GltfPair::commit() {
  if (passing_json_) {
    passing_buffer_->commit();
    passing_json_->commit();
  }
  buffer_.commit();
  json_.commit();
  ::unlink(names(json_.path())[2].c_str());
}

}  // namespace weft
