// Reading, compiling and reloading of shaders.
#include "picture/shader.h"

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "failure.h"

namespace weft::viewer {

namespace fs = std::filesystem;

namespace {

fs::file_time_type time_of(const fs::path& path) {
  std::error_code error;
  const fs::file_time_type time = fs::last_write_time(path, error);
  return error ? fs::file_time_type::min() : time;
}

// Texture units, the same in every program (see Renderer).
constexpr std::pair<const char*, int> kUnits[] = {
    {"u_sky", 0},           {"u_shadow", 1},         {"u_texture", 2},
    {"u_height", 3},        {"u_base_color_map", 4}, {"u_metallic_map", 5},
    {"u_roughness_map", 6}, {"u_normal_map", 7},     {"u_depth", 8},
    {"u_occlusion", 9}};

}  // namespace

fs::path find_shaders() {
  std::error_code error;
  std::vector<fs::path> places;
  if (const char* chosen = std::getenv("WEFT_SHADERS")) places.emplace_back(chosen);
  const fs::path here = fs::read_symlink("/proc/self/exe", error).parent_path();
  places.insert(places.end(),
                {here / "../share/weft/shaders", WEFT_SOURCE_SHADERS, WEFT_INSTALLED_SHADERS});
  std::string tried;
  for (const fs::path& place : places) {
    if (fs::exists(place / "common.glsl", error)) return place;
    tried += (tried.empty() ? "" : ", ") + place.string();
  }
  throw Failure(kNoGraphics, "the shaders are not found in " + tried +
                                 " (the variable WEFT_SHADERS names their folder)");
}

Shader::Shader(fs::path folder, std::string name)
    : folder_(std::move(folder)), name_(std::move(name)) {
  load();
}

bool Shader::reload_if_changed() {
  bool changed = false;
  for (const File& file : files_) changed = changed || time_of(file.path) != file.time;
  if (!changed) return false;
  load();
  return error_.empty();
}

// The text with every #include "FILE" replaced by that file; #line keeps the messages' numbers.
std::string Shader::read(const fs::path& path, int depth) {
  files_.push_back({path, time_of(path)});
  std::ifstream file(path);
  if (!file) throw std::runtime_error(path.string() + " cannot be read");
  if (depth > 8) throw std::runtime_error(path.string() + " includes itself");
  std::string text, line;
  for (int number = 1; std::getline(file, line); ++number) {
    const std::size_t open = line.starts_with("#include") ? line.find('"') : std::string::npos;
    const std::size_t close = open == std::string::npos ? open : line.find('"', open + 1);
    if (close == std::string::npos) {
      text += line + "\n";
    } else {
      text += "#line 1\n" + read(folder_ / line.substr(open + 1, close - open - 1), depth + 1);
      text += "#line " + std::to_string(number + 1) + "\n";
    }
  }
  return text;
}

ShaderObject Shader::compile(GLenum stage, const std::string& extension) {
  const fs::path path = folder_ / (name_ + extension);
  const char* define = stage == GL_VERTEX_SHADER ? "WEFT_VERTEX" : "WEFT_FRAGMENT";
  const std::string text =
      std::string("#version 330 core\n#define ") + define + "\n#line 1\n" + read(path, 0);
  const char* const source = text.c_str();
  ShaderObject shader(glCreateShader(stage));
  glShaderSource(shader.id(), 1, &source, nullptr);
  glCompileShader(shader.id());
  GLint good = 0;
  glGetShaderiv(shader.id(), GL_COMPILE_STATUS, &good);
  if (good != 0) return shader;
  std::string log(4096, '\0');
  GLsizei size = 0;
  glGetShaderInfoLog(shader.id(), static_cast<GLsizei>(log.size()), &size, log.data());
  log.resize(static_cast<std::size_t>(size));
  throw std::runtime_error(path.filename().string() + ": " + log);
}

void Shader::load() {
  files_.clear();
  error_.clear();
  try {
    const ShaderObject vertex = compile(GL_VERTEX_SHADER, ".vert");
    const ShaderObject fragment = compile(GL_FRAGMENT_SHADER, ".frag");
    ProgramObject program(glCreateProgram());
    glAttachShader(program.id(), vertex.id());
    glAttachShader(program.id(), fragment.id());
    glLinkProgram(program.id());
    GLint good = 0;
    glGetProgramiv(program.id(), GL_LINK_STATUS, &good);
    if (good == 0) {
      std::string log(4096, '\0');
      glGetProgramInfoLog(program.id(), static_cast<GLsizei>(log.size()), nullptr, log.data());
      throw std::runtime_error(name_ + ": " + log.c_str());
    }
    program_ = std::move(program);
  } catch (const std::runtime_error& failure) {
    error_ = failure.what();
    for (const char* extension : {".vert", ".frag"}) {  // watched even if never read
      const fs::path path = folder_ / (name_ + extension);
      files_.push_back({path, time_of(path)});
    }
    return;
  }
  use();
  for (const auto& [sampler, unit] : kUnits) set(sampler, unit);
  const GLuint frame = glGetUniformBlockIndex(program_.id(), "Frame");
  if (frame != GL_INVALID_INDEX) glUniformBlockBinding(program_.id(), frame, 0);
}

void Shader::set(const char* uniform, int value) const {
  glUniform1i(glGetUniformLocation(program_.id(), uniform), value);
}
void Shader::set(const char* uniform, float value) const {
  glUniform1f(glGetUniformLocation(program_.id(), uniform), value);
}
void Shader::set(const char* uniform, float x, float y) const {
  glUniform2f(glGetUniformLocation(program_.id(), uniform), x, y);
}
void Shader::set(const char* uniform, Vec3f v) const {
  glUniform3f(glGetUniformLocation(program_.id(), uniform), v.x, v.y, v.z);
}
void Shader::set(const char* uniform, Vec3f v, float w) const {
  glUniform4f(glGetUniformLocation(program_.id(), uniform), v.x, v.y, v.z, w);
}
void Shader::set(const char* uniform, const Mat4& value) const {
  glUniformMatrix4fv(glGetUniformLocation(program_.id(), uniform), 1, GL_FALSE, value.m.data());
}

}  // namespace weft::viewer
