// Shader files -> programs: reading with #include "…", compiling, and compiling again when a file
// changes. A shader that does not compile leaves the last good program in use and says why.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "picture/gl.h"
#include "picture/linear.h"

namespace weft::viewer {

// The folder of the shaders: $WEFT_SHADERS, beside the program as installed, then the source tree.
// Throws Failure when there is none.
std::filesystem::path find_shaders();

class Shader {
 public:
  // Reads NAME.vert and NAME.frag; what is wrong is in error().
  Shader(std::filesystem::path folder, std::string name);

  // Compiles again when a file has changed since; true when there is a new program.
  bool reload_if_changed();

  const std::string& name() const { return name_; }
  const std::string& error() const { return error_; }  // "" when the newest files compile
  bool usable() const { return static_cast<bool>(program_); }

  void use() const { glUseProgram(program_.id()); }
  void set(const char* uniform, int value) const;
  void set(const char* uniform, float value) const;
  void set(const char* uniform, float x, float y) const;
  void set(const char* uniform, Vec3f value) const;
  void set(const char* uniform, Vec3f value, float w) const;
  void set(const char* uniform, const Mat4& value) const;

 private:
  struct File {
    std::filesystem::path path;
    std::filesystem::file_time_type time;
  };

  void load();
  ShaderObject compile(GLenum stage, const std::string& extension);
  std::string read(const std::filesystem::path& path, int depth);

  std::filesystem::path folder_;
  std::string name_;
  std::vector<File> files_;  // all that were read
  ProgramObject program_;
  std::string error_;
};

}  // namespace weft::viewer
