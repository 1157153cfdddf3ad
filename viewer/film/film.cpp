// Raw pictures into ffmpeg's standard input.
#include "film/film.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "failure.h"
#include "weft/printable.h"

namespace weft::viewer {

namespace {

constexpr const char* kFailed = ": the film could not be written (ffmpeg tells the terminal why)";

bool has_ffmpeg() {
  return std::system("command -v ffmpeg >/dev/null 2>&1") == 0;
}

// For the shell.
std::string for_shell(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

template <class Do>
void attempt(Do&& action) {
  try {
    action();
  } catch (const WriteError& error) {
    throw Failure(kCannotWrite, printable(error.path) + ": " + error.what());
  }
}

}  // namespace

bool same_file(const std::string& a, const std::string& b) {
  return !a.empty() && !b.empty() && find_clash({{"a", a}, {"b", b}}, {}).has_value();
}

std::string full_path(const std::string& path) {
  std::error_code error;
  const std::filesystem::path full = std::filesystem::absolute(path, error);
  return printable(error ? path : full.lexically_normal().string());
}

std::string free_name(const std::string& base, const std::string& extension,
                      const std::string& besides) {
  std::error_code error;
  std::string path = base + extension;
  for (int n = 2; std::filesystem::exists(path, error) || same_file(path, besides); ++n)
    path = base + "-" + std::to_string(n) + extension;
  return path;
}

Film::Film(const std::string& base, const std::string& besides, int width, int height, double start,
           bool waits)
    : width_(width), height_(height), start_(start), last_(start), waits_(waits) {
  if (!has_ffmpeg()) {
    static constexpr std::string_view kFirst = "_00000.png";
    path_ = free_name(base, std::string(kFirst), besides);
    base_ = path_.substr(0, path_.size() - kFirst.size());
    return;
  }
  path_ = free_name(base, ".mp4", besides);
  // ffmpeg would find out too late what cannot be written, and tell the terminal only.
  attempt([&] { file_.emplace(path_); });
  // Ctrl-C at the terminal is for this program, which then ends the film: ffmpeg does not hear it.
  const std::string command =
      "exec $(command -v setsid) ffmpeg -y -loglevel error -f rawvideo -pix_fmt rgb24 -s " +
      std::to_string(width) + "x" + std::to_string(height) + " -r " +
      std::to_string(static_cast<int>(kRate)) +
      " -i - -c:v libx264 -preset veryfast -crf 20 -pix_fmt yuv420p -f mp4 " +
      for_shell(file_->temporary());
  pipe_.reset(::popen(command.c_str(), "w"));
}

Film::~Film() {
  pipe_.reset();  // before the file that it writes to goes
}

int Film::due(double time) {
  if (time < start_ && count_ == 0) return 0;
  if (time < last_) start_ = time - static_cast<double>(count_) / kRate;
  last_ = time;
  // The scene had run on before it knew of the film.
  if (count_ == 1 && !waits_) start_ = std::max(start_, time - 1 / kRate);
  constexpr double kRounding = 1e-6;  // pictures
  const double wanted = std::floor((time - start_) * kRate + kRounding) + 1;
  return static_cast<int>(std::clamp(wanted - static_cast<double>(count_), 0.0, 30.0));
}

void Film::add(const Picture& picture, int times) {
  for (int n = 0; n < times; ++n, ++count_) {
    if (file_) {
      if (!pipe_ ||
          std::fwrite(picture.rgb.data(), 1, picture.rgb.size(), pipe_.get()) != picture.rgb.size())
        throw Failure(kCannotWrite, printable(path_) + kFailed);
      continue;
    }
    char number[16];
    std::snprintf(number, sizeof number, "_%05ld.png", count_);
    write_png(base_ + number, picture);
  }
}

void Film::finish() {
  if (!file_) return;
  if (::pclose(pipe_.release()) != 0) throw Failure(kCannotWrite, printable(path_) + kFailed);
  attempt([&] { file_->commit(); });
}

}  // namespace weft::viewer
